#pragma once

#include "storage/jobs/job_queue.hpp"
#include "storage/postgres/server_connection.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace macadam {

// Logs are announced before their objects are stored (table macadam.announced_log), so that the
// object store keeps none of which the queue does not know, whatever fails in between.

/// Announces logs that the caller stores now, and submits within a day: submit_logs() ends the
/// announcement. Meanwhile workers do not erase the objects of those that are done. Waits for who
/// erases one just now.
/// \param objects  location where he stores them; "" = that of the workers, whichever it is
/// \throws InputError  if workers look for them elsewhere.
void announce_logs(ServerConnection& server,
                   std::span<const Job> logs,
                   const std::string& objects = {});

/// Ends announcements that are older than a day, at most `limit`, in the transaction of the caller,
/// who is to erase the objects of these logs in it: who announces one again waits for that.
/// \returns the hashes of those that were not submitted, by nobody.
std::vector<std::string> end_old_announcements(ServerConnection& server, std::size_t limit);

} // namespace macadam
