#pragma once

#include "app/cli/console.hpp"
#include "app/import/trip_inputs.hpp"
#include "app/pipeline/pipeline.hpp"
#include "app/pipeline/vehicle_lookup.hpp"
#include "storage/store/road_store.hpp"
#include "storage/trips/trip_reader.hpp"

#include <functional>
#include <string>
#include <vector>

namespace macadam {

/// Result of one trip's import.
struct TripOutcome {
    enum class Result { imported, known, rejected, reprocessed, unknown };
    std::string file;
    std::string trip_id;
    std::string sha256;
    Result result = Result::rejected;
    TripResult trip;
    std::string vehicle;
    bool built_in_vehicle = false; ///< not from a user's file
    std::string error;             ///< reason for rejection
    TripRecord record;
};

std::string_view name_of(TripOutcome::Result result);

struct ImportTotals {
    std::size_t imported = 0; ///< or reprocessed
    std::size_t known = 0;    ///< or unknown: unchanged
    std::size_t rejected = 0;
    std::size_t passes = 0;
    bool interrupted = false; ///< progress.stop was requested before the rest was processed

    std::size_t looked_at() const { return imported + known + rejected; }
};

struct ImportWork {
    std::size_t jobs = 1;
    bool readmit = false; ///< include trips that were forgotten
    /// Receives warnings about the network beside the database.
    std::function<void(const std::string&)> warn{};
};

/// Imports trips into a database. `jobs` threads read and estimate them; this thread writes them in
/// order, in commit batches of 1 s (at most 100 trips), and reports each batch once it is on disk.
/// An unusable trip is reported as an outcome and never stops the others. An error of the database
/// itself is thrown; trips committed before stay. On a stop request the current trip is finished or
/// dropped and the rest is skipped.
ImportTotals import_trips(RoadStore& store,
                          AskedTrips& trips,
                          VehicleChoice& vehicles,
                          const PipelineConfig& config,
                          const ImportWork& work,
                          const Progress& progress,
                          const std::function<void(const TripOutcome&)>& tell);

/// Reprocesses trips of the database in the same way and stages them in it
/// (StoreMaintenance::stage_trip). Trips that are not in the database are unknown.
ImportTotals reprocess_trips(RoadStore& store,
                             AskedTrips& trips,
                             VehicleChoice& vehicles,
                             const PipelineConfig& config,
                             std::size_t jobs,
                             const Progress& progress,
                             const std::function<void(const TripOutcome&)>& tell);

} // namespace macadam
