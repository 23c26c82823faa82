#include "app/import/trip_processing.hpp"

#include "app/import/trip_progress.hpp"
#include "app/pipeline/single_trip.hpp"

#include "storage/trips/log/trip_meta.hpp"
#include "storage/trips/trip_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

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
    record.trimmed_mm = thousandths(trimmed_before_m(meta));
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
std::vector<std::string> unchanged_car_text(const ImportContext& context,
                                            const std::string& sha256) {
    const auto& car = context.vehicles.named_car();
    if (!car || context.store.trips->is_trip_of(sha256, *car)) {
        return {};
    }
    return {
        fmt::format("was imported for another car, or for none; its car is unchanged. To change "
                    "it: macadam forget {} --trip {}, then import it again with --take-back",
                    context.store.name.string(),
                    sha256)};
}

/// Gives a log that names no car the one with which it is stored, if a vehicle has its name.
/// \throws InputError  if --vehicle-id names another.
void name_stored_car(const ImportContext& context,
                     const TripSource& source,
                     const std::string& sha256,
                     TripMeta& meta) {
    const auto names = context.vehicles.names_for(source.file);
    const std::scoped_lock lock{context.store_in_use};
    if (const auto contradiction = unchanged_car_text(context, sha256); !contradiction.empty()) {
        throw InputError{contradiction.front()};
    }
    const auto stored = std::ranges::find_if(
        names, [&](const auto& name) { return context.store.trips->is_trip_of(sha256, name); });
    if (meta.vehicle_id.empty() && stored != names.end()) {
        meta.vehicle_id = *stored;
    }
}

/// Returns the settings with which a trip was imported, as far as the database keeps them and
/// others are asked for: "--method kf --vehicle van"; "" = none.
std::string earlier_settings(const ImportContext& context, const std::string& sha256) {
    const auto earlier = context.store.trips->settings_of_trip(sha256);
    std::vector<std::string> words;
    if (earlier && earlier->method != name_of(context.work.pipeline.estimator.method)) {
        words.push_back("--method " + earlier->method);
    }
    const auto& car = context.vehicles.for_all();
    if (earlier && car && earlier->vehicle_model != model_name(*car)) {
        words.push_back(earlier->vehicle_model == own_file_model
                            ? std::string{"a vehicle file"}
                            : "--vehicle " + earlier->vehicle_model);
    }
    return fmt::format("{}", fmt::join(words, " and "));
}

/// Looks up a trip by the hash of its content. Returns whether to skip it; the report says why.
bool is_skipped(const ImportContext& context, const std::string& sha256, TripReport& report) {
    using Result = TripReport::Result;
    const auto skip = [&](Result result, std::vector<std::string> warnings) {
        report.result = result;
        report.warnings = std::move(warnings);
        report.error.clear();
        return true;
    };
    report.sha256 = sha256;
    const std::scoped_lock lock{context.store_in_use};
    const bool is_known = context.store.trips->contains_trip(sha256);
    if (context.work.restaged != nullptr) {
        return !is_known &&
               skip(Result::unknown, {"is not in the database: import it with 'macadam import'"});
    }
    if (is_known) {
        auto warnings = known_text(context.work.pipeline.trim);
        std::ranges::move(unchanged_car_text(context, sha256), std::back_inserter(warnings));
        report.earlier_settings = earlier_settings(context, sha256);
        return skip(Result::known, std::move(warnings));
    }
    return !context.work.readmit && context.store.trips->has_forgotten(sha256) &&
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
std::optional<TripLog> read_once(const ImportContext& context,
                                 const TripSource& source,
                                 TripReport& report,
                                 const Progress& progress) {
    std::optional<OpenTrip> trip;
    std::optional<std::string> sha256;
    report.error = refusal_in(report.file, [&] { sha256 = trip.emplace(source).sha256_ahead(); });
    if (!report.error.empty() || (sha256 && is_skipped(context, *sha256, report))) {
        return std::nullopt;
    }
    std::optional<TripLog> log;
    report.error = refusal_in(report.file, [&] { log = trip->read(needs_of_import(), progress); });
    if (sha256 || (!log && context.stop.stop_requested())) {
        return log;
    }
    const auto unreadable = refusal_in(report.file, [&] { sha256 = trip->sha256(); });
    if (!unreadable.empty()) {
        report.error = unreadable;
    }
    return !sha256 || is_skipped(context, *sha256, report) ? std::nullopt : std::move(log);
}

/// Estimates and matches a trip.
void add_passes(ProcessedTrip& trip,
                const ImportContext& context,
                const TripSource& source,
                TripLog log,
                const Progress& progress) {
    auto& report = trip.report;
    with_trip_name(report.file, [&] {
        context.vehicles.name_car(log.meta);
        if (context.work.restaged != nullptr) {
            name_stored_car(context, source, report.sha256, log.meta);
        }
    });
    const auto meta = log.meta;
    report.trip_id = meta.trip_id;
    const auto chosen = context.vehicles(source.file, meta);
    report.vehicle = chosen.vehicle.name;
    report.rows.read = report.rows.rejected = log.rows.size();
    auto result = with_trip_name(report.file, [&] {
        return passes_of(
            std::move(log), chosen.vehicle, context.roads, context.work.pipeline, progress);
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
                            context.work.pipeline.estimator.method);
    trip.passes = std::move(result.passes);
    trip.traces = std::move(result.traces);
    trip.events = std::move(result.events);
}

// Reading takes about a tenth of the time of a trip, estimating the rest.
constexpr std::size_t trip_is_read = TripProgress::whole_trip / 10;

} // namespace

ProcessedTrip process_trip(const ImportContext& context, const TripSource& source) {
    using Result = TripReport::Result;
    ProcessedTrip trip;
    auto& report = trip.report;
    report.file = source.name();
    TripProgress progress{context.done, context.stop};
    auto log = read_once(context, source, report, progress.step(0, trip_is_read));
    if (!log) {
        return trip;
    }
    report.error = refusal_in(report.file, [&] {
        const auto estimating = progress.step(trip_is_read, TripProgress::whole_trip);
        add_passes(trip, context, source, std::move(*log), estimating);
    });
    if (report.error.empty()) {
        if (report.outside_at) {
            report.warnings.clear(); // about values that are not stored
            report.is_stored = context.work.restaged != nullptr;
        }
        report.result = report.outside_at                  ? Result::outside
                        : context.work.restaged != nullptr ? Result::reprocessed
                                                           : Result::imported;
    } else if (report.rows.read > 0) {
        report.rows.reasons = {{"trip_rejected", report.rows.read}};
    }
    return trip;
}

} // namespace macadam
