#include "app/report/control_monitoring.hpp"

#include "estimator/common/statistics.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <cmath>

namespace macadam {
namespace {

/// Returns the middle of a month such as "2026-03", in years.
double years_of(const std::string& month) {
    return std::stod(month.substr(0, 4)) + (std::stod(month.substr(5, 2)) - 0.5) / 12;
}

std::vector<ControlReading> readings_of(const WatchedSection& watched) {
    std::vector<ControlReading> readings;
    for (const auto& [month, segments, road] : watched.months) {
        readings.push_back(
            {years_of(month), road.mean.iri - watched.section.iri_mm_per_m, road.mean.sd});
    }
    return readings;
}

/// Returns the segments of the section, cut to it, with states from the cars' passes of a period.
std::vector<SegmentRecord> records_of(const StoreReader& store,
                                      const ControlSection& section,
                                      const std::optional<Period>& period) {
    SegmentFilter filter;
    filter.way_id = section.way_id;
    filter.period = period;
    filter.cars_alone = true;
    std::vector<SegmentRecord> records;
    store.visit(filter, [&](const SegmentRecord& record) { records.push_back(record); });
    return cut_to(section, std::move(records));
}

RoadMean mean_of(const std::vector<SegmentRecord>& records) {
    std::vector<MeasuredPiece> pieces;
    double at_m = 0;
    for (const auto& record : records) {
        const double length_m = record.segment.to_m - record.segment.from_m;
        pieces.push_back({length_m, at_m + length_m / 2, &*record.state});
        at_m += length_m;
    }
    return measured_road(pieces, {}).mean;
}

WatchedSection watched(const StoreReader& store, const ControlSection& section) {
    WatchedSection found{section, mean_of(records_of(store, section, {}))};
    if (found.cars.length_m <= 0) {
        return found;
    }
    found.off = found.cars.iri - section.iri_mm_per_m;
    found.off_sd = std::hypot(found.cars.sd, section.sd_mm_per_m);
    found.months = history_by_month(
        [&](const Period& period) {
            const bool whole = !period.from_ms && !period.until_ms;
            return records_of(store, section, whole ? std::nullopt : std::optional{period});
        },
        {});
    found.drift = drift_of(readings_of(found));
    return found;
}

std::string day_of(const std::optional<std::int64_t>& utc_ms) {
    return utc_ms ? utc_day(*utc_ms) : "undated";
}

Cell day_cell(const std::optional<std::int64_t>& utc_ms) {
    return utc_ms ? Cell{day_of(utc_ms)} : Cell{};
}

std::string json_of(const std::vector<MonthRow>& months, double known, UnitSystem units) {
    const Columns<MonthRow> columns{
        {"month", as::text, [](auto& r) { return r.month; }},
        {"iri", as::iri(3), [](auto& r) { return r.road.mean.iri; }},
        {"iri_sd", as::iri(3), [](auto& r) { return r.road.mean.sd; }},
        {"difference", as::iri(3), [known](auto& r) { return r.road.mean.iri - known; }},
        {"length_m", as::metres(2), [](auto& r) { return r.road.mean.length_m; }},
        {"vehicles", as::integer, [](auto& r) { return r.road.vehicles; }}};
    return json_rows(in_units(columns, units), months);
}

Cell json_of(const std::optional<Drift>& drift, UnitSystem units) {
    static const Columns<Drift> columns{
        {"per_year", as::iri(4), [](auto& r) { return r.per_year; }},
        {"sd_per_year", as::iri(4), [](auto& r) { return r.sd_per_year; }},
        {"significant", as::truth, [](auto& r) { return r.significant; }}};
    return drift ? Cell{json_object(in_units(columns, units), *drift).text()} : Cell{};
}

Cell of_drift(const WatchedSection& watched, double Drift::*value) {
    return watched.drift ? Cell{(*watched.drift).*value} : Cell{};
}

bool has_pass(const WatchedSection& watched) {
    return watched.cars.length_m > 0;
}

Cell of_cars(const WatchedSection& watched, double value) {
    return has_pass(watched) ? Cell{value} : Cell{};
}

/// Difference from the known value, with some standard deviations.
Cell difference_of(const WatchedSection& watched, double sds) {
    return of_cars(watched, watched.off + sds * watched.off_sd);
}

// Words of a table, which shows nothing after "no pass yet".

std::string cars_words(const WatchedSection& watched) {
    return has_pass(watched) ? fmt::format("{:.2f}", watched.cars.iri) : " no pass yet";
}

std::string bias_words(const WatchedSection& watched) {
    return has_pass(watched) ? fmt::format("{:>+7.2f} ± {:<5.2f} ",
                                           watched.off,
                                           normal_interval_90 * watched.off_sd)
                             : "";
}

std::string drift_words(const WatchedSection& watched) {
    if (!watched.drift) {
        return has_pass(watched) ? fmt::format("too few months ({} of {})",
                                               watched.months.size(),
                                               min_control_readings)
                                 : "";
    }
    const auto& [per_year, sd, significant] = *watched.drift;
    return fmt::format("{:+.2f} ± {:.2f} a year{}",
                       per_year,
                       normal_interval_90 * sd,
                       significant ? ": DRIFTS" : "");
}

} // namespace

// clang-format off
Columns<WatchedSection> control_section_columns(UnitSystem units) {
    return in_units<WatchedSection>({
    {"name", as::text, [](auto& r) { return r.section.name; }, {"control section", "{:<18.18}"}},
    {"way_id", as::integer, [](auto& r) { return r.section.way_id; }},
    {"direction", as::text, [](auto& r) { return r.section.forward ? "forward" : "backward"; }},
    {"from_m", as::metres(3), [](auto& r) { return r.section.from_m; }},
    {"to_m", as::metres(3), [](auto& r) { return r.section.to_m; }},
    {"date", as::day, [](auto& r) { return day_cell(r.section.utc_ms); }},
    {"known_iri", as::iri(3), [](auto& r) { return r.section.iri_mm_per_m; },
     {"known", " {:>6}", 2}},
    {"known_sd", as::iri(3), [](auto& r) { return r.section.sd_mm_per_m; }},
    {"measured_m", as::metres(2), [](auto& r) { return r.cars.length_m; }},
    {"iri", as::iri(3), [](auto& r) { return of_cars(r, r.cars.iri); }},
    {"iri_sd", as::iri(3), [](auto& r) { return of_cars(r, r.cars.sd); }},
    {"difference", as::iri(3), [](auto& r) { return of_cars(r, r.off); }},
    {"difference_low", as::iri(3), [](auto& r) { return difference_of(r, -normal_interval_90); }},
    {"difference_high", as::iri(3), [](auto& r) { return difference_of(r, normal_interval_90); }},
    {"drift", as::json_only(as::raw), [units](auto& r) { return json_of(r.drift, units); }},
    {"drift_per_year", as::csv_only(as::iri(4)),
     [](auto& r) { return of_drift(r, &Drift::per_year); }},
    {"drift_sd_per_year", as::csv_only(as::iri(4)),
     [](auto& r) { return of_drift(r, &Drift::sd_per_year); }},
    {"", as::numbers_in("mm/m"), cars_words, {"cars", " {:>6}"}},
    {"", as::numbers_in("mm/m"), bias_words, {"bias (90 %)", " {:>16}"}},
    {"", as::metres(0), [](auto& r) { return of_cars(r, r.cars.length_m); }, {"metres", " {:>9}"}},
    {"", as::numbers_in("mm/m"), drift_words, {"drift, mm/m (90 %)", "  {}"}},
    {"months", as::json_only(as::raw),
     [units](auto& r) { return json_of(r.months, r.section.iri_mm_per_m, units); }},
    }, units);
}

Columns<SurveyUse> survey_columns(UnitSystem units) {
    return in_units<SurveyUse>({
    {"name", as::text, [](auto& r) { return r.name; }, {"reference survey", "{:<24.24}"}},
    {"file", as::text, [](auto& r) { return r.file_name; }},
    {"sha256", as::text, [](auto& r) { return r.sha256; }},
    {"date", as::day, [](auto& r) { return day_cell(r.utc_ms); }},
    {"", as::text, [](auto& r) { return day_of(r.utc_ms); }, {"date", " {:<10}"}},
    {"accuracy", as::real(4), [](auto& r) { return r.relative_sd; }},
    {"", as::text, [](auto& r) { return fmt::format("{:.1f} %", 100 * r.relative_sd); },
     {"accuracy", " {:>8}"}},
    {"", as::text, [units](auto& r) { return length_words(std::round(r.row_m), units); }, {"rows of", " {:>8}"}},
    {"row_m", as::metres(2), [](auto& r) { return r.row_m; }},
    {"rows_read", as::integer, [](auto& r) { return r.rows_read; }},
    {"rows_used", as::integer, [](auto& r) { return r.rows_used; }},
    {"segments", as::integer, [](auto& r) { return r.passes; }, {"segments", " {:>9}"}},
    {"km", as::real(3, "km"), [](auto& r) { return r.km; }, {"km", " {:>9}", 2}},
    {"alone_km", as::real(3, "km"), [](auto& r) { return r.alone_km; },
     {"km, no car", " {:>13}", 2}},
    }, units);
}
// clang-format on

std::vector<WatchedSection> watched_sections(const StoreReader& store) {
    std::vector<WatchedSection> all;
    if (store.shows_published_alone()) {
        return all;
    }
    for (const auto& section : store.control_sections()) {
        all.push_back(watched(store, section));
    }
    return all;
}

} // namespace macadam
