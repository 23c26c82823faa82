#pragma once

#include "app/cli/console.hpp"
#include "app/import/import_run.hpp"
#include "app/pipeline/vehicle_lookup.hpp"
#include "storage/jobs/job_queue.hpp"
#include "storage/objects/object_store.hpp"
#include "storage/store/import_store.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// Job whose log was fetched, or why it could not be.
struct FetchedJob {
    /// Beside `fetched`: the object is missing or damaged; the store could not be asked; it was not
    /// asked any more, because it could not be for another job.
    enum class Result : std::uint8_t { fetched, unusable, unreachable, left };

    Job job;
    std::filesystem::path file;
    Result result = Result::left;
    std::string failure{}; ///< of an unusable object or an unreachable store
};

/// Fetches the logs of jobs into a folder and verifies their hashes, on as many threads as there
/// are stores. Ends early when a store cannot be reached.
std::vector<FetchedJob> fetch_jobs(const std::vector<Job>& jobs,
                                   const std::filesystem::path& folder,
                                   std::span<const std::unique_ptr<ObjectStore>> stores);

/// Jobs after an import: what became of them, and those that a stop request left.
struct WorkedJobs {
    std::vector<JobEnd> ends;
    std::vector<Job> left;
};

/// Estimates and matches the trips of jobs, and writes their passes; does not fuse. The files are
/// removed.
///
/// \throws InputError  if the database cannot be written; what it has is known to the next attempt.
WorkedJobs import_jobs(ImportStore& store,
                       const std::vector<FetchedJob>& jobs,
                       const ImportOptions& options,
                       VehicleChoice& vehicles,
                       const Console& console);

} // namespace macadam
