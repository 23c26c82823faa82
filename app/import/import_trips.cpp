#include "app/import/import_trips.hpp"

#include "app/import/ordered_worker_pool.hpp"
#include "app/pipeline/privacy_trim.hpp"
#include "app/pipeline/single_trip.hpp"

#include "storage/networks/network_file.hpp"
#include "storage/trips/trip_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <iterator>
#include <mutex>
#include <new>
#include <optional>
#include <utility>

namespace macadam {
namespace {

/// One trip on its way into the database.
struct ProcessedTrip {
    TripReport report;
    TripRecord record; ///< valid, as are passes and traces, if the report says so
    std::vector<Pass> passes;
    std::vector<RoughnessTrace> traces;
    std::optional<std::vector<PassEvent>> events;
};

/// What all workers share.
struct Intake {
    RoadStore& store;
    std::mutex& store_in_use;
    VehicleChoice& vehicles;
    const RoadNetwork& roads;
    const ImportWork& work; ///< with the database's trim rule
    std::stop_token stop;
};

std::int64_t thousandths(double value) {
    return std::llround(value * 1000);
}

TripRecord record_of(const TripSource& source,
                     const TripMeta& meta,
                     const TripReport& report,
                     const std::optional<std::int64_t>& begin_ms,
                     const std::string& vehicle_model,
                     Method method) {
    TripRecord record;
    record.sha256 = report.sha256;
    record.trip_id = meta.trip_id;
    record.vehicle_id = meta.vehicle_id;
    record.file_name = source.file.filename().string();
    if (meta.t0_utc_s && begin_ms) {
        record.t0_utc_ms = thousandths(*meta.t0_utc_s) + *begin_ms;
    }
    record.vehicle_model = vehicle_model;
    record.method = method == Method::kf ? "kf" : "smoother";
    record.distance_mm = thousandths(report.distance_m);
    record.matched_mm = thousandths(report.matched_m);
    record.rows_read = report.rows.read;
    record.rows_used = report.rows.used;
    record.row_reasons = report.rows.reasons;
    return record;
}

/// Returns the messages for a trip that is already in the database.
std::vector<std::string> known_text(const TrimRule& trim) {
    if (trim.is_active() && !trim.hides_places) {
        return {"was imported before and stays unchanged: its ends cannot be removed "
                "afterwards; import it into a new database for that"};
    }
    return {};
}

/// Returns a message if the car of --vehicle-id is not that with which a trip is stored.
std::vector<std::string> unchanged_car_text(const Intake& intake, const std::string& sha256) {
    const auto& car = intake.vehicles.named_car();
    if (!car || intake.store.is_trip_of(sha256, *car)) {
        return {};
    }
    return {fmt::format("is in the database with another car or none, which stays: to change it, "
                        "'macadam forget --trip {}', then import it with --take-back",
                        sha256)};
}

/// Looks up a trip by the hash of its content. Returns whether to skip it; the report says why.
bool is_skipped(const Intake& intake, const std::string& sha256, TripReport& report) {
    using Result = TripReport::Result;
    const auto skip = [&](Result result, std::vector<std::string> warnings) {
        report.result = result;
        report.warnings = std::move(warnings);
        report.error.clear();
        return true;
    };
    report.sha256 = sha256;
    const std::scoped_lock lock{intake.store_in_use};
    const bool is_known = intake.store.contains_trip(sha256);
    if (intake.work.reprocess) {
        return !is_known &&
               skip(Result::unknown, {"is not in the database: import it with 'macadam import'"});
    }
    if (is_known) {
        auto warnings = known_text(intake.work.pipeline.trim);
        std::ranges::move(unchanged_car_text(intake, sha256), std::back_inserter(warnings));
        return skip(Result::known, std::move(warnings));
    }
    return !intake.work.readmit && intake.store.has_forgotten(sha256) &&
           skip(Result::known, {"was permanently deleted on request; --take-back re-admits it"});
}

/// Runs a step of a trip. Returns why the trip has to be rejected, "" if it does not.
template <typename Step>
std::string refusal_in(const std::string& file, Step step) {
    try {
        step();
        return "";
    } catch (const std::bad_alloc&) {
        return file + ": not enough memory";
    } catch (const std::exception& error) {
        return error.what();
    }
}

/// Reads a trip once, and looks it up before parsing if its content is short. If there is no log to
/// process, the report says why.
std::optional<TripLog>
read_once(const Intake& intake, const TripSource& source, TripReport& report) {
    std::optional<OpenTrip> trip;
    std::optional<std::string> sha256;
    report.error = refusal_in(report.file, [&] { sha256 = trip.emplace(source).sha256_ahead(); });
    if (!report.error.empty() || (sha256 && is_skipped(intake, *sha256, report))) {
        return std::nullopt;
    }
    std::optional<TripLog> log;
    const Progress progress{.report = {}, .stop = intake.stop};
    report.error = refusal_in(report.file, [&] { log = trip->read(needs_of_import(), progress); });
    if (sha256 || (!log && intake.stop.stop_requested())) {
        return log;
    }
    const auto unreadable = refusal_in(report.file, [&] { sha256 = trip->sha256(); });
    if (!unreadable.empty()) {
        report.error = unreadable;
    }
    return !sha256 || is_skipped(intake, *sha256, report) ? std::nullopt : std::move(log);
}

/// Estimates and matches a trip.
void add_passes(ProcessedTrip& trip, const Intake& intake, const TripSource& source, TripLog log) {
    auto& report = trip.report;
    with_trip_name(report.file, [&] { intake.vehicles.name_car(log.meta); });
    const auto meta = log.meta;
    report.trip_id = meta.trip_id;
    const auto chosen = intake.vehicles(source.file, meta.vehicle_id);
    report.vehicle = chosen.vehicle.name;
    report.rows.read = report.rows.rejected = log.rows.size();
    auto result = with_trip_name(report.file, [&] {
        return passes_of(std::move(log), chosen.vehicle, intake.roads, intake.work.pipeline);
    });
    report.rows = std::move(result.rows);
    report.distance_m = result.distance_m;
    report.matched_m = result.matched_m;
    report.passes = result.passes.size();
    report.warnings = std::move(result.warnings);
    if (!chosen.warning.empty()) {
        report.warnings.push_back(chosen.warning);
    }
    if (!meta.t0_utc_s) {
        report.warnings.emplace_back("no date in the log (t0_utc): date filters ignore this trip");
    }
    // A car from a user's file is named after its vehicle_id, which the database does not keep.
    trip.record = record_of(source,
                            meta,
                            report,
                            result.begin_ms,
                            chosen.built_in ? chosen.vehicle.name : std::string{own_file_model},
                            intake.work.pipeline.estimator.method);
    trip.passes = std::move(result.passes);
    trip.traces = std::move(result.traces);
    trip.events = std::move(result.events);
}

/// Processes one trip from file to passes. Its errors become part of the report; those of the
/// database are thrown.
ProcessedTrip process_trip(const Intake& intake, const TripSource& source) {
    using Result = TripReport::Result;
    ProcessedTrip trip;
    auto& report = trip.report;
    report.file = source.name();
    auto log = read_once(intake, source, report);
    if (!log) {
        return trip;
    }
    report.error =
        refusal_in(report.file, [&] { add_passes(trip, intake, source, std::move(*log)); });
    if (report.error.empty()) {
        report.result = intake.work.reprocess ? Result::reprocessed : Result::imported;
    } else if (report.rows.read > 0) {
        report.rows.reasons = {{"trip_rejected", report.rows.read}};
    }
    return trip;
}

bool has_passes(const TripReport& report) {
    return report.result == TripReport::Result::imported ||
           report.result == TripReport::Result::reprocessed;
}

/// Writes the trips that have passes. The same trip may occur twice; the second one is then known.
void put(const Intake& intake, std::vector<ProcessedTrip>& trips) {
    using Result = TripReport::Result;
    std::vector<ProcessedTrip*> made;
    for (auto& trip : trips) {
        if (has_passes(trip.report)) {
            made.push_back(&trip);
        }
    }
    if (made.empty()) {
        return;
    }
    const std::scoped_lock lock{intake.store_in_use};
    if (intake.work.reprocess) {
        for (auto* const trip : made) {
            auto& report = trip->report;
            if (!intake.store.maintenance.stage_trip(
                    {&trip->record, trip->passes, trip->traces, false, trip->events})) {
                report.result = Result::unknown;
                continue;
            }
            std::ranges::move(unchanged_car_text(intake, report.sha256),
                              std::back_inserter(report.warnings));
        }
        return;
    }
    std::vector<NewTrip> together;
    for (const auto* const trip : made) {
        together.push_back(
            {&trip->record, trip->passes, trip->traces, intake.work.readmit, trip->events});
    }
    const auto is_new = intake.store.importer.add_trips(together);
    for (std::size_t i = 0; i < made.size(); ++i) {
        made[i]->report.result = is_new[i] ? Result::imported : Result::known;
    }
}

using Clock = std::chrono::steady_clock;
using TripPool = OrderedWorkerPool<TripSource, ProcessedTrip>;

// A commit takes the same disk time for one trip as for many. Uncommitted trips must be processed
// again after a kill.
constexpr std::size_t most_together = 100; // trips
constexpr std::size_t max_passes_together = 50'000;
constexpr std::chrono::seconds longest_together{1};

/// Trips that are committed together and then reported, in their order.
class CommitBatch {
public:
    void add(ProcessedTrip trip) {
        if (trips_.empty()) {
            due_ = Clock::now() + longest_together;
        }
        passes_ += trip.passes.size();
        trips_.push_back(std::move(trip));
    }

    /// Time of the next commit; `std::nullopt` if no trip waits.
    TripPool::Deadline due() const { return trips_.empty() ? TripPool::Deadline{} : due_; }

    bool is_full() const {
        return trips_.size() >= most_together || passes_ >= max_passes_together ||
               (!trips_.empty() && Clock::now() >= due_);
    }

    std::vector<ProcessedTrip> empty() {
        passes_ = 0;
        return std::exchange(trips_, {});
    }

private:
    std::vector<ProcessedTrip> trips_;
    std::size_t passes_ = 0;
    Clock::time_point due_;
};

void add(ImportTotals& totals, const TripReport& report) {
    const bool is_taken = has_passes(report);
    const bool is_rejected = report.result == TripReport::Result::rejected;
    totals.imported += is_taken ? 1U : 0U;
    totals.rejected += is_rejected ? 1U : 0U;
    totals.known += !is_taken && !is_rejected ? 1U : 0U;
    totals.passes += is_taken ? report.passes : 0U;
}

ImportTotals process_trips(const Intake& intake,
                           AskedTrips& trips,
                           const Progress& progress,
                           const std::function<void(const TripReport&)>& tell) {
    ImportTotals totals;
    TripPool pool{[&] { return trips.next(); },
                  intake.work.jobs,
                  [&](const TripSource& source) { return process_trip(intake, source); }};
    CommitBatch batch;
    const auto commit = [&] {
        auto together = batch.empty();
        put(intake, together);
        for (const auto& trip : together) {
            add(totals, trip.report);
            tell(trip.report);
            progress(totals.looked_at(), std::max(totals.looked_at(), trips.at_least()));
        }
    };
    const auto& stop = progress.stop;
    for (std::size_t i = 0;; ++i) {
        if (stop.stop_requested() && trips.count() != i) {
            totals.interrupted = true;
            break;
        }
        auto taken = pool.take(i, batch.due(), stop);
        if (!taken.result && !taken.over) { // a long trip: earlier ones do not wait for it
            commit();
            taken = pool.take(i, {}, stop);
        }
        if (taken.over) {
            break;
        }
        // After a stop a trip is possibly rejected only because of the stop.
        if (!taken.result || (stop.stop_requested() &&
                              taken.result->report.result == TripReport::Result::rejected)) {
            totals.interrupted = true;
            break;
        }
        batch.add(std::move(*taken.result));
        if (batch.is_full() || totals.looked_at() == 0) { // the first report comes soon
            commit();
        }
    }
    commit();
    return totals;
}

} // namespace

std::string_view name_of(TripReport::Result result) {
    switch (result) {
    case TripReport::Result::imported:
        return "imported";
    case TripReport::Result::known:
        return "known";
    case TripReport::Result::reprocessed:
        return "reprocessed";
    case TripReport::Result::unknown:
        return "unknown";
    case TripReport::Result::rejected:
        break;
    }
    return "rejected";
}

ImportTotals import_trips(RoadStore& store,
                          AskedTrips& trips,
                          VehicleChoice& vehicles,
                          const ImportWork& asked,
                          const Progress& progress,
                          const std::function<void(const TripReport&)>& tell) {
    const auto roads = load_or_build_network(store, asked.warn);
    auto work = asked;
    work.pipeline.trim = trim_in(store, asked.pipeline.trim);
    std::mutex store_in_use;
    return process_trips(
        {store, store_in_use, vehicles, roads, work, progress.stop}, trips, progress, tell);
}

} // namespace macadam
