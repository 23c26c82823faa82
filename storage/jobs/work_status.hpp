#pragma once

#include "storage/postgres/server_connection.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Worker, as the queue sees it.
struct WorkerStatus {
    std::string name;
    bool is_alive = false;
    std::int64_t results_version = 0;
    std::int64_t jobs = 0;     ///< trips at the same time
    std::int64_t working = 0;  ///< logs that it has taken
    std::int64_t finished = 0; ///< logs
    double seen_s = 0;         ///< since its last sign
};

/// Log that was parked or refused.
struct FailedLog {
    std::string sha256;
    std::string state;
    std::string reason;
    std::int64_t attempts = 0;
    std::int64_t finished_ms = 0; ///< ms since 1970 UTC
};

/// More chunks that wait for fusion are not counted: a country has millions, and servers ask often.
inline constexpr std::int64_t max_chunks_counted = 100'000;

/// State of the queue of a database at one moment.
struct WorkStatus {
    std::map<std::string, std::int64_t> logs; ///< by state, all of them
    double oldest_s = 0;                      ///< since the submission of the oldest log that waits
    std::int64_t accepted_in_minute = 0, accepted_in_hour = 0; ///< logs submitted first
    std::int64_t finished_in_minute = 0, finished_in_hour = 0; ///< logs
    std::int64_t passes_in_hour = 0;
    std::int64_t chunks_to_fuse = 0;    ///< counted up to max_chunks_counted
    std::optional<std::string> objects; ///< location of the object store
    std::vector<WorkerStatus> workers;
    std::vector<FailedLog> failed; ///< the latest parked, then the latest refused
};

/// Tests whether the role may read the queue, which readers of roads may not.
bool may_read_work(ServerConnection& server);

/// \param max_failed  length of WorkStatus::failed
WorkStatus work_status(ServerConnection& server, std::size_t max_failed);

/// Number of the log that was submitted last, 0 if none was.
std::int64_t last_log_number(ServerConnection& server);

/// Logs that wait, without those that were submitted after some log.
struct Backlog {
    std::int64_t waiting = 0;
    bool is_worked_on = false;                 ///< a worker that lives has some of them
    std::optional<std::chrono::seconds> lease; ///< longest of workers that live; none lives without
};

/// \param last  number of that log
Backlog backlog_up_to(ServerConnection& server, std::int64_t last);

} // namespace macadam
