#include "app/import/import_trips.hpp"

#include "app/import/commit_batch.hpp"
#include "app/import/ordered_worker_pool.hpp"
#include "app/import/trip_progress.hpp"
#include "app/pipeline/privacy_trim.hpp"
#include "app/pipeline/single_trip.hpp"

#include "storage/networks/network_file.hpp"
#include "storage/trips/trip_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <iterator>
#include <mutex>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

/// What all workers share.
struct Intake {
    RoadStore& store;
    std::mutex& store_in_use;
    VehicleChoice& vehicles;
    const RoadNetwork& roads;
    const ImportWork& work; ///< with the database's trim rule
    std::stop_token stop;
    std::atomic<std::size_t>& done; ///< thousandths of trips
};

std::int64_t thousandths(double value) {
    return std::llround(value * 1000);
}

std::string_view name_of(Method method) {
    return method == Method::kf ? "kf" : "smoother";
}

/// Returns the name of a car that may be stored. A car from a user's file is named after its
/// vehicle_id, which the database does not keep.
std::string model_name(const ChosenVehicle& car) {
    return car.built_in ? car.vehicle.name : std::string{own_file_model};
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
    record.method = name_of(method);
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
    return {
        fmt::format("was imported for another car, or for none; its car is unchanged. To change "
                    "it: macadam forget {} --trip {}, then import it again with --take-back",
                    intake.store.file().string(),
                    sha256)};
}

/// Gives a log that names no car the one with which it is stored, if a vehicle has its name.
/// \throws InputError  if --vehicle-id names another.
void name_stored_car(const Intake& intake,
                     const TripSource& source,
                     const std::string& sha256,
                     TripMeta& meta) {
    const auto names = intake.vehicles.names_for(source.file);
    const std::scoped_lock lock{intake.store_in_use};
    if (const auto contradiction = unchanged_car_text(intake, sha256); !contradiction.empty()) {
        throw InputError{contradiction.front()};
    }
    const auto stored = std::ranges::find_if(
        names, [&](const auto& name) { return intake.store.is_trip_of(sha256, name); });
    if (meta.vehicle_id.empty() && stored != names.end()) {
        meta.vehicle_id = *stored;
    }
}

/// Returns the settings with which a trip was imported, as far as the database keeps them and
/// others are asked for: "--method kf --vehicle van"; "" = none.
std::string earlier_settings(const Intake& intake, const std::string& sha256) {
    const auto earlier = intake.store.settings_of_trip(sha256);
    std::vector<std::string> words;
    if (earlier && earlier->method != name_of(intake.work.pipeline.estimator.method)) {
        words.push_back("--method " + earlier->method);
    }
    const auto& car = intake.vehicles.for_all();
    if (earlier && car && earlier->vehicle_model != model_name(*car)) {
        words.push_back(earlier->vehicle_model == own_file_model
                            ? std::string{"a vehicle file"}
                            : "--vehicle " + earlier->vehicle_model);
    }
    return fmt::format("{}", fmt::join(words, " and "));
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
        report.earlier_settings = earlier_settings(intake, sha256);
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
std::optional<TripLog> read_once(const Intake& intake,
                                 const TripSource& source,
                                 TripReport& report,
                                 const Progress& progress) {
    std::optional<OpenTrip> trip;
    std::optional<std::string> sha256;
    report.error = refusal_in(report.file, [&] { sha256 = trip.emplace(source).sha256_ahead(); });
    if (!report.error.empty() || (sha256 && is_skipped(intake, *sha256, report))) {
        return std::nullopt;
    }
    std::optional<TripLog> log;
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
void add_passes(ProcessedTrip& trip,
                const Intake& intake,
                const TripSource& source,
                TripLog log,
                const Progress& progress) {
    auto& report = trip.report;
    with_trip_name(report.file, [&] {
        intake.vehicles.name_car(log.meta);
        if (intake.work.reprocess) {
            name_stored_car(intake, source, report.sha256, log.meta);
        }
    });
    const auto meta = log.meta;
    report.trip_id = meta.trip_id;
    const auto chosen = intake.vehicles(source.file, meta.vehicle_id);
    report.vehicle = chosen.vehicle.name;
    report.rows.read = report.rows.rejected = log.rows.size();
    auto result = with_trip_name(report.file, [&] {
        return passes_of(
            std::move(log), chosen.vehicle, intake.roads, intake.work.pipeline, progress);
    });
    report.rows = std::move(result.rows);
    report.distance_m = result.distance_m;
    report.matched_m = result.matched_m;
    report.passes = result.passes.size();
    report.outside_at = result.outside_at;
    report.warnings = std::move(result.warnings);
    if (!chosen.warning.empty()) {
        report.warnings.push_back(chosen.warning);
    }
    if (!meta.t0_utc_s) {
        report.warnings.emplace_back("no date in the log (t0_utc): date filters ignore this trip");
    }
    trip.record = record_of(source,
                            meta,
                            report,
                            result.begin_ms,
                            model_name(chosen),
                            intake.work.pipeline.estimator.method);
    trip.passes = std::move(result.passes);
    trip.traces = std::move(result.traces);
    trip.events = std::move(result.events);
}

// Reading takes about a tenth of the time of a trip, estimating the rest.
constexpr std::size_t trip_is_read = TripProgress::whole_trip / 10;

/// Processes one trip from file to passes. Its errors become part of the report; those of the
/// database are thrown.
ProcessedTrip process_trip(const Intake& intake, const TripSource& source) {
    using Result = TripReport::Result;
    ProcessedTrip trip;
    auto& report = trip.report;
    report.file = source.name();
    TripProgress progress{intake.done, intake.stop};
    auto log = read_once(intake, source, report, progress.step(0, trip_is_read));
    if (!log) {
        return trip;
    }
    report.error = refusal_in(report.file, [&] {
        const auto estimating = progress.step(trip_is_read, TripProgress::whole_trip);
        add_passes(trip, intake, source, std::move(*log), estimating);
    });
    if (report.error.empty()) {
        if (report.outside_at) {
            report.warnings.clear(); // about values that are not stored
        }
        report.result = report.outside_at       ? Result::outside
                        : intake.work.reprocess ? Result::reprocessed
                                                : Result::imported;
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
            }
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

void add(ImportTotals& totals, const TripReport& report) {
    const bool is_taken = has_passes(report);
    const bool is_rejected = report.result == TripReport::Result::rejected;
    const bool is_outside = report.result == TripReport::Result::outside;
    totals.imported += is_taken ? 1U : 0U;
    totals.rejected += is_rejected ? 1U : 0U;
    totals.known += !is_taken && !is_rejected && !is_outside ? 1U : 0U;
    totals.passes += is_taken ? report.passes : 0U;
    if (is_outside) {
        totals.outside.push_back(*report.outside_at);
    }
    if (!report.earlier_settings.empty()) {
        ++totals.earlier_settings[report.earlier_settings];
    }
}

/// Import of many trips: workers read and estimate, the caller's thread commits, fuses and reports.
class TripImport {
public:
    TripImport(const Intake& intake,
               AskedTrips& trips,
               const Progress& progress,
               const std::function<void(const TripReport&)>& tell)
        : intake_{intake}, trips_{trips}, progress_{progress}, tell_{tell},
          pool_{[this] { return trips_.next(); },
                intake.work.jobs,
                [this](const TripSource& source) { return process_trip(intake_, source); }} {}

    ImportTotals run() {
        const auto& stop = progress_.stop;
        for (std::size_t i = 0;; ++i) {
            if (stop.stop_requested() && trips_.count() != i) {
                totals_.interrupted = true;
                break;
            }
            auto taken = take(i);
            if (taken.over) {
                break;
            }
            // After a stop a trip is possibly rejected only because of the stop.
            if (!taken.result || (stop.stop_requested() &&
                                  taken.result->report.result == TripReport::Result::rejected)) {
                totals_.interrupted = true;
                break;
            }
            batch_.add(std::move(*taken.result));
            if (batch_.is_full() || totals_.looked_at() == 0) { // the first report comes soon
                commit();
                fuse_if_due();
            }
        }
        commit();
        return std::move(totals_);
    }

private:
    /// Waits for a trip. Earlier ones do not wait for a long one: they are committed and fused.
    TripPool::Taken take(std::size_t number) {
        constexpr std::chrono::milliseconds look_every{250};
        for (;;) {
            const auto look = Clock::now() + look_every;
            auto taken =
                pool_.take(number, std::min(batch_.due().value_or(look), look), progress_.stop);
            if (taken.result || taken.over || progress_.stop.stop_requested()) {
                return taken;
            }
            if (batch_.is_full()) {
                commit();
            }
            fuse_if_due();
            show_progress();
        }
    }

    void commit() {
        auto together = batch_.empty();
        put(intake_, together);
        for (const auto& trip : together) {
            add(totals_, trip.report);
            tell_(trip.report);
            has_unfused_ = has_unfused_ || has_passes(trip.report);
        }
        show_progress();
    }

    void fuse_if_due() {
        if (!has_unfused_ || intake_.work.reprocess ||
            Clock::now() - fused_at_ < intake_.work.fuse_every) {
            return;
        }
        const std::scoped_lock lock{intake_.store_in_use};
        totals_.fused += intake_.store.importer.refresh({.report = {}, .stop = progress_.stop});
        has_unfused_ = false;
        fused_at_ = Clock::now();
    }

    void show_progress() const {
        const auto whole = std::max(totals_.looked_at(), trips_.at_least());
        progress_(intake_.done, whole * TripProgress::whole_trip);
    }

    const Intake& intake_;
    AskedTrips& trips_;
    const Progress& progress_;
    const std::function<void(const TripReport&)>& tell_;
    ImportTotals totals_;
    CommitBatch batch_;
    bool has_unfused_ = false;
    Clock::time_point fused_at_ = Clock::now();
    TripPool pool_; // last member: its workers use the others
};

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
    case TripReport::Result::outside:
        return "outside";
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
    std::atomic<std::size_t> done = 0;
    const Intake intake{store, store_in_use, vehicles, roads, work, progress.stop, done};
    return TripImport{intake, trips, progress, tell}.run();
}

} // namespace macadam
