#pragma once

#include "storage/jobs/job_queue.hpp"
#include "storage/postgres/server_connection.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace macadam {

/// Worker as others see it: table macadam.worker.
struct WorkerEntry {
    JobTaker taker;
    int results_version = 0; ///< see app/pipeline/results_version.hpp
    std::size_t jobs = 1;    ///< trips at the same time
};

/// The workers of a database compute results of another version.
struct OtherResults : InputError {
    using InputError::InputError;
};

/// Asks for the version of results that workers of a database decided on: a key and a value, as of
/// table meta; no row before the first one.
inline constexpr const char* results_version_row =
    "SELECT key, value FROM macadam.work_setting WHERE key = 'results_version'";

/// \param theirs  that version; "" before the first worker, which fits all
/// \throws OtherResults  if it is not `ours`.
void expect_results_version(const ServerConnection& server, const std::string& theirs, int ours);
void expect_results_version(ServerConnection& server, int ours);

/// Name for a worker that begins: machine, process and a random number.
std::string new_worker_name();

/// Registers a worker. The first one decides with which version of results this database is filled;
/// `takes_over` changes that while no other worker lives.
///
/// \throws OtherResults  if workers of another version fill the database.
void begin_worker(ServerConnection& server, const WorkerEntry& entry, bool takes_over);

/// Tells that a worker lives, and renews the leases of its jobs.
/// \param finished  jobs that it has finished
void renew_worker(ServerConnection& server, const JobTaker& taker, std::int64_t finished);

/// Removes a worker that ends.
void end_worker(ServerConnection& server, const std::string& name);

/// Location of the object store, as it was submitted to last; `std::nullopt` before that.
std::optional<std::string> objects_location(ServerConnection& server);
/// Keeps it until the end of the transaction. \param location  "" = whichever it is
/// \throws InputError  if it is another one.
void share_objects_location(ServerConnection& server, const std::string& location);
/// Waits for those who submit just now.
/// \throws InputError  if it differs from the last one, where logs still lie, whatever became of
///                     them, or which a worker that lives has open.
void put_objects_location(ServerConnection& server, const std::string& location);

} // namespace macadam
