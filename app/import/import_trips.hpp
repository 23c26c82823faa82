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

/// What became of one trip.
struct TripOutcome {
    enum class Result { imported, known, rejected, reprocessed, unknown };
    std::string file;
    std::string trip_id;
    std::string sha256;
    Result result = Result::rejected;
    TripResult trip;
    std::string vehicle;
    bool built_in_vehicle = false; ///< not one of the user's files
    std::string error;             ///< why it was rejected
    TripRecord record;
};

std::string_view name_of(TripOutcome::Result result);

struct ImportTotals {
    std::size_t imported = 0; ///< or reprocessed
    std::size_t known = 0;    ///< or unknown: left as they are
    std::size_t rejected = 0;
    std::size_t passes = 0;
    bool interrupted = false; ///< the rest was not looked at: progress.stop was requested before

    std::size_t looked_at() const { return imported + known + rejected; }
};

struct ImportWork {
    std::size_t jobs = 1;
    bool readmit = false;                           ///< also trips that were forgotten
    std::function<void(const std::string&)> warn{}; ///< of the network beside the store
};

/// Brings trips into a store: read and estimated by `jobs` threads, written by this one in the
/// order of the trips, those of a second (but no more than 100) in one transaction, and told when
/// that is on the disk. A trip that cannot be used is an outcome and never stops
/// the others; an error of the store itself is thrown and leaves the trips before it in place.
/// When a stop is requested, the trip at hand is finished or dropped and the rest is left.
ImportTotals import_trips(RoadStore& store,
                          AskedTrips& trips,
                          VehicleChoice& vehicles,
                          const PipelineConfig& config,
                          const ImportWork& work,
                          const Progress& progress,
                          const std::function<void(const TripOutcome&)>& tell);

/// Works trips of the store out anew in the same way, and lays them aside in it
/// (RoadStore::stage_trip). Trips that it does not have are unknown.
ImportTotals reprocess_trips(RoadStore& store,
                             AskedTrips& trips,
                             VehicleChoice& vehicles,
                             const PipelineConfig& config,
                             std::size_t jobs,
                             const Progress& progress,
                             const std::function<void(const TripOutcome&)>& tell);

} // namespace macadam
