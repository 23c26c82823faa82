#pragma once

#include "app/cli/console.hpp"
#include "app/import/trip_inputs.hpp"
#include "app/pipeline/pipeline.hpp"
#include "app/pipeline/vehicle_lookup.hpp"
#include "storage/store/import_store.hpp"

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Report on one trip of an import: its result, counts and warnings.
struct TripReport {
    enum class Result { imported, known, rejected, outside, reprocessed, unknown };
    Result result = Result::rejected;
    std::string file;
    std::string trip_id;
    std::string sha256;
    std::string vehicle;
    RowCount rows;
    double distance_m = 0;
    double matched_m = 0;   ///< part of distance_m on roads of the network
    std::size_t passes = 0; ///< number
    std::vector<std::string> warnings;
    std::string error;                    ///< reason for rejection
    std::optional<GeoPoint> outside_at{}; ///< middle of a trip whose result is `outside`
    bool is_stored = false;               ///< its earlier passes are in the database
    /// Settings with which a known trip was imported, if others are asked for: "--method kf".
    std::string earlier_settings{};
};

std::string_view name_of(TripReport::Result result);

struct ImportTotals {
    std::size_t imported = 0; ///< or reprocessed
    std::size_t known = 0;    ///< or unknown: unchanged
    std::size_t rejected = 0;
    std::size_t passes = 0;
    FusionRecord fusion;                                 ///< what was fused meanwhile
    std::vector<GeoPoint> outside;                       ///< middle of each trip outside the map
    std::map<std::string, std::size_t> earlier_settings; ///< known trips by TripReport's settings
    bool interrupted = false; ///< progress.stop was requested before the rest was processed

    std::size_t looked_at() const { return imported + known + rejected + outside.size(); }
};

/// Options of an import: how trips are estimated, and which of them are stored.
struct ImportWork {
    PipelineConfig pipeline;
    std::size_t jobs = 1; ///< threads that read and estimate
    /// Takes the new results of trips that are in the database, of which others are skipped
    /// (StoreMaintenance::stage_trip). Null: trips that are not in the database are imported.
    StoreMaintenance* restaged = nullptr;
    bool readmit = false; ///< include trips that were forgotten
    /// Pause between fusions of committed trips, which show them to readers. Longer where fusing
    /// takes long, so that it takes at most a fifth of the time.
    std::chrono::milliseconds fuse_every{45'000};
    /// Receives warnings about the network beside the database.
    std::function<void(const std::string&)> warn{};
};

/// Imports or reprocesses trips. `jobs` threads read and estimate them; this thread writes them in
/// order, in commit batches of 1 s (at most 100 trips), and reports each batch once it is on disk.
/// An unusable trip is reported and never stops the others. New passes are fused every
/// `fuse_every`, those of the last trips are left to the caller. Progress counts thousandths of
/// trips. An error of the database itself is thrown; trips committed before stay. On a stop request
/// the current trip is finished or dropped and the rest is skipped.
ImportTotals import_trips(ImportStore& store,
                          AskedTrips& trips,
                          VehicleChoice& vehicles,
                          const ImportWork& work,
                          const Progress& progress,
                          const std::function<void(const TripReport&)>& tell);

} // namespace macadam
