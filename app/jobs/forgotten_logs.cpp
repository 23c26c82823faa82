#include "app/jobs/forgotten_logs.hpp"

#include "app/jobs/job_options.hpp"
#include "estimator/common/error.hpp"
#include "storage/jobs/job_queue.hpp"
#include "storage/jobs/worker_register.hpp"
#include "storage/objects/object_store.hpp"

#include <fmt/format.h>

namespace macadam {

void erase_forgotten_logs(const std::string& address, const Console& console) {
    auto server = opened_server(address);
    const auto jobs = end_forgotten_jobs(server);
    const auto location = objects_location(server);
    if (jobs.empty() || !location) {
        return;
    }
    try {
        const auto objects = open_object_store(*location, console.stop(), MissingFolder::refuse);
        for (const auto& job : jobs) {
            objects->remove(job.sha256);
        }
    } catch (const InputError& error) {
        console.warn(
            fmt::format("{} of deleted trips still in the object store; the next worker "
                        "erases {}: {}",
                        jobs.size() == 1 ? "a log is" : fmt::format("{} logs are", jobs.size()),
                        jobs.size() == 1 ? "it" : "them",
                        error.what()));
        return;
    }
    remove_forgotten_jobs(server, jobs);
    console.say(fmt::format("{} erased from {}", counted(jobs.size(), "submitted log"), *location));
}

} // namespace macadam
