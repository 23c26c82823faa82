#pragma once

#include "storage/jobs/job_queue.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/uploads/upload_queue.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

// Logs of the queue of a server as those see them who sent them by a token: who sent which, what
// became of it, and its deletion. As the uploads of a file (storage/uploads/upload_queue.hpp).

std::optional<Upload> find_sent_log(ServerConnection& server, const std::string& sha256);

/// Latest logs of an owner, or of all for "", newest first, at most `limit`.
std::vector<Upload>
latest_sent_logs(ServerConnection& server, const std::string& owner, std::size_t limit);

/// Counts logs that wait, up to `most`.
std::size_t count_waiting_logs(ServerConnection& server, std::size_t most);

/// Tells again of a log that is known: when this returns, a standby has it, too.
void confirm_log(ServerConnection& server, const std::string& sha256);

/// Deletes a log of which no trip is in the database, or marks its trips to be forgotten by a
/// worker.
/// \returns the job, whose object is to be erased (remove_forgotten_jobs()); `std::nullopt`: it is
///          marked, or gone.
std::optional<Job> delete_log(ServerConnection& server, const std::string& sha256);

/// Tests whether the role may forget trips, and some are to be forgotten.
bool has_deletions(ServerConnection& server);

/// Hashes of trips of logs that are to be deleted and are worked out, at most `limit`.
std::vector<std::string> trips_to_delete(ServerConnection& server, std::size_t limit);

/// Ends jobs of logs that are to be deleted, of which no trip is left: workers erase their objects.
void end_deleted_jobs(ServerConnection& server);

} // namespace macadam
