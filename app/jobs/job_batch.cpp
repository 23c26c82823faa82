#include "app/jobs/job_batch.hpp"

#include "app/import/trip_inputs.hpp"
#include "app/import/trip_progress.hpp"
#include "app/jobs/log_outcome.hpp"
#include "app/parallel/parallel_for.hpp"
#include "estimator/common/error.hpp"
#include "storage/trips/trip_file_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <system_error>
#include <utility>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::hours never_within_a_batch{24 * 365}; // the worker fuses, by age

bool is_archive(const fs::path& file) {
    return is_archive_name(file.filename().string());
}

void fetch(FetchedJob& one, ObjectStore& store) {
    std::error_code ignored;
    fs::remove(one.file, ignored); // left by a batch that failed
    try {
        store.fetch({one.job.sha256, one.job.bytes}, one.file);
        one.result = FetchedJob::Result::fetched;
    } catch (const UnusableObject& error) {
        one.result = FetchedJob::Result::unusable;
        one.failure = error.what();
    } catch (const InputError& error) {
        one.result = FetchedJob::Result::unreachable;
        one.failure = error.what();
    }
}

} // namespace

std::vector<FetchedJob> fetch_jobs(const std::vector<Job>& jobs,
                                   const fs::path& folder,
                                   std::span<const std::unique_ptr<ObjectStore>> stores) {
    std::vector<FetchedJob> fetched;
    for (const auto& job : jobs) {
        fetched.push_back({.job = job, .file = folder / (job.sha256 + job.suffix)});
    }
    const auto lanes = std::min(stores.size(), fetched.size());
    std::atomic<bool> is_reachable = true;
    parallel_for(lanes, lanes, [&](std::size_t lane) {
        for (std::size_t i = lane; i < fetched.size() && is_reachable; i += lanes) {
            fetch(fetched[i], *stores[lane]);
            if (fetched[i].result == FetchedJob::Result::unreachable) {
                is_reachable = false;
            }
        }
    });
    return fetched;
}

WorkedJobs import_jobs(ImportStore& store,
                       const std::vector<FetchedJob>& jobs,
                       const ImportOptions& options,
                       VehicleChoice& vehicles,
                       const Console& console) {
    assert(!jobs.empty());
    std::vector<fs::path> files;
    for (const auto& one : jobs) {
        files.push_back(one.file);
    }
    const auto folder = files.front().parent_path();
    const Console quiet{Verbosity::quiet, console.stop()};
    AskedTrips trips{files, {.max_files = options.max_members}, quiet};
    std::vector<LogOutcome> outcomes(jobs.size());
    const auto totals =
        import_trips(store,
                     trips,
                     vehicles,
                     {.pipeline = options.pipeline,
                      .jobs = options.jobs,
                      .fuse_every = never_within_a_batch,
                      .warn = [&](const std::string& words) { console.detail(words); }},
                     {.report = {}, .stop = console.stop()},
                     [&](const TripReport& report) {
                         for (std::size_t i = 0; i < jobs.size(); ++i) {
                             if (is_of(report, jobs[i].file)) {
                                 add(outcomes[i],
                                     report,
                                     jobs[i].file,
                                     jobs[i].job.attempts > 1 || jobs[i].job.was_begun);
                             }
                         }
                         if (options.tell) {
                             auto told = report; // where the log lay meanwhile is no matter
                             told.file = fs::path{report.file}.lexically_relative(folder).string();
                             options.tell(told);
                         }
                     });
    WorkedJobs worked;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const bool is_whole =
            !totals.interrupted || (outcomes[i].trips() > 0 && !is_archive(jobs[i].file));
        if (is_whole) {
            auto fate = fate_of(outcomes[i]);
            worked.ends.push_back({.job = jobs[i].job,
                                   .state = fate.state,
                                   .reason = std::move(fate.reason),
                                   .passes = outcomes[i].passes,
                                   .trips = std::move(outcomes[i].stored),
                                   .own = std::move(outcomes[i].own)});
        } else {
            worked.left.push_back(jobs[i].job);
        }
        std::error_code ignored;
        fs::remove(jobs[i].file, ignored);
    }
    return worked;
}

} // namespace macadam
