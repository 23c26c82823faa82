#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "app/import/import_trips.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace macadam {

/// Settings of a worker of a database on a server.
struct JobWork {
    std::string address;
    std::string objects;            ///< location of the object store; "" = as submitted last
    Arguments import_arguments;     ///< options of `import` by which logs are imported
    std::chrono::seconds lease{60}; ///< after which others take the jobs of a dead worker
    bool until_empty = false;       ///< ends when nothing waits, nor is worked on by others
    std::optional<std::int64_t>
        last_log{};          ///< number, see work_status.hpp: later ones do not count
    bool keeps_logs = false; ///< in the object store, once they are imported
    bool takes_over = false; ///< with another version of results
    std::function<void(const TripReport&)> tell{}; ///< receives the report of each trip
};

/// Works out the queue of a database: takes jobs, fetches and verifies their logs, imports them,
/// and fuses new passes once the oldest is 45 s old or nothing waits. Any number of workers share a
/// queue; a kill at any moment loses no log and counts none twice. After an error of the server it
/// connects again, and jobs whose attempt that ended are tried again. While the object store cannot
/// be reached, jobs wait, and no attempt counts.
///
/// \throws InputError  at the begin, if the server or the object store cannot be used; later if a
///                     worker that works until the queue is empty meets an error of the server
///                     or the object store, or workers of other results took over.
void work_out_jobs(const JobWork& work, const Console& console);

} // namespace macadam
