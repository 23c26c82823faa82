#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"
#include "app/import/import_trips.hpp"
#include "app/pipeline/pipeline.hpp"
#include "app/pipeline/vehicle_lookup.hpp"
#include "storage/store/import_store.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

namespace macadam {

inline constexpr Option trim_option{
    "--trim", "METRES", "Remove the first and last N metres of each trip, for privacy.", "0"};

/// Options of commands that import trips.
struct ImportOptions {
    std::size_t jobs;
    bool json;
    bool readmit = false;
    PipelineConfig pipeline;
    std::shared_ptr<const TripMapping> mapping;
    std::filesystem::path positions{}; ///< of the only trip; empty: its own, or beside it
    std::size_t max_members;
    std::filesystem::path named_after{}; ///< identifies the import in the journal; empty: its paths
    bool tells_known = true;             ///< whether trips that were imported before are reported
    /// Receives the report of each trip, once it is on disk, in place of standard output.
    std::function<void(const TripReport&)> tell{};
};

/// Parses --jobs, --json, --trim, --mapping, --max-members and the options of the estimation.
/// \throws UsageError  for invalid values.
ImportOptions parse_import(const Arguments& arguments);

/// Imports the trips of paths, fuses their passes, and prints their reports and a summary. A lock
/// and a journal in the database tell others of the import, and the next one of an interruption.
///
/// \throws InputError  after a stop request, if trips or segments are left.
ImportTotals import_paths(ImportStore& store,
                          const std::vector<std::filesystem::path>& paths,
                          const ImportOptions& options,
                          VehicleChoice& vehicles,
                          const Console& console);

/// Fuses new passes, after a stop request only for a short time.
///
/// \returns the number of segments.
/// \throws InputError  after a stop request, if segments are left.
std::size_t fuse_new_passes(ImportStore& store, const Console& console);

} // namespace macadam
