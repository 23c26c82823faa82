#include "app/report/control_monitoring.hpp"

#include "app/cli/terminal_escape.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>

namespace macadam {
namespace {

constexpr double z_of_90_percent = 1.645;

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
std::vector<SegmentRecord> records_of(const RoadStore& store,
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

WatchedSection watched(const RoadStore& store, const ControlSection& section) {
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

JsonValue json_day(const std::optional<std::int64_t>& utc_ms) {
    return utc_ms ? JsonValue{day_of(utc_ms)} : JsonValue{nullptr};
}

std::string drift_words(const WatchedSection& watched) {
    if (!watched.drift) {
        return fmt::format(
            "too few months ({} of {})", watched.months.size(), min_control_readings);
    }
    const auto& [per_year, sd, significant] = *watched.drift;
    return fmt::format(
        "{:+.2f} ± {:.2f} a year{}", per_year, z_of_90_percent * sd, significant ? ": DRIFTS" : "");
}

std::string json_of(const MonthRow& month, double known) {
    JsonObject object;
    object.add("month", month.month)
        .add("iri", JsonNumber{month.road.mean.iri, 3})
        .add("iri_sd", JsonNumber{month.road.mean.sd, 3})
        .add("difference", JsonNumber{month.road.mean.iri - known, 3})
        .add("length_m", JsonNumber{month.road.mean.length_m, 2})
        .add("vehicles", std::int64_t{month.road.vehicles});
    return object.text();
}

std::string json_of(const Drift& drift) {
    JsonObject object;
    object.add("per_year", JsonNumber{drift.per_year, 4})
        .add("sd_per_year", JsonNumber{drift.sd_per_year, 4})
        .add("significant", drift.significant);
    return object.text();
}

std::string json_of(const WatchedSection& watched) {
    const auto& section = watched.section;
    const auto known = [&](double value) {
        return watched.cars.length_m > 0 ? JsonValue{JsonNumber{value, 3}} : JsonValue{nullptr};
    };
    std::vector<std::string> months;
    for (const auto& month : watched.months) {
        months.push_back(json_of(month, section.iri_mm_per_m));
    }
    JsonObject object;
    object.add("name", section.name)
        .add("way_id", section.way_id)
        .add("direction", section.forward ? std::string{"forward"} : std::string{"backward"})
        .add("from_m", JsonNumber{section.from_m, 3})
        .add("to_m", JsonNumber{section.to_m, 3})
        .add("date", json_day(section.utc_ms))
        .add("known_iri", JsonNumber{section.iri_mm_per_m, 3})
        .add("known_sd", JsonNumber{section.sd_mm_per_m, 3})
        .add("measured_m", JsonNumber{watched.cars.length_m, 2})
        .add("iri", known(watched.cars.iri))
        .add("iri_sd", known(watched.cars.sd))
        .add("difference", known(watched.off))
        .add("difference_low", known(watched.off - z_of_90_percent * watched.off_sd))
        .add("difference_high", known(watched.off + z_of_90_percent * watched.off_sd))
        .add("drift",
             watched.drift ? JsonValue{JsonRaw{json_of(*watched.drift)}} : JsonValue{nullptr})
        .add("months", JsonRaw{json_array(months)});
    return object.text();
}

std::string json_of(const SurveyUse& survey) {
    JsonObject object;
    object.add("name", survey.name)
        .add("file", survey.file_name)
        .add("sha256", survey.sha256)
        .add("date", json_day(survey.utc_ms))
        .add("accuracy", JsonNumber{survey.relative_sd, 4})
        .add("row_m", JsonNumber{survey.row_m, 2})
        .add("rows_read", static_cast<std::int64_t>(survey.rows_read))
        .add("rows_used", static_cast<std::int64_t>(survey.rows_used))
        .add("segments", static_cast<std::int64_t>(survey.passes))
        .add("km", JsonNumber{survey.km, 3})
        .add("alone_km", JsonNumber{survey.alone_km, 3});
    return object.text();
}

template <typename Values>
std::string array_of(const Values& values) {
    std::vector<std::string> objects;
    for (const auto& value : values) {
        objects.push_back(json_of(value));
    }
    return json_array(objects);
}

} // namespace

std::vector<WatchedSection> watched_sections(const RoadStore& store) {
    std::vector<WatchedSection> all;
    if (store.shows_published_alone()) {
        return all;
    }
    for (const auto& section : store.control_sections()) {
        all.push_back(watched(store, section));
    }
    return all;
}

std::string text_of(const std::vector<WatchedSection>& sections) {
    if (sections.empty()) {
        return {};
    }
    auto text = fmt::format("\n{:<18} {:>6} {:>6} {:>16} {:>9}  {}\n",
                            "control section",
                            "known",
                            "cars",
                            "bias (90 %)",
                            "metres",
                            "drift, mm/m (90 %)");
    for (const auto& watched : sections) {
        const auto name = printable_name(watched.section.name);
        if (watched.cars.length_m <= 0) {
            text += fmt::format(
                "{:<18.18} {:>6.2f}  no pass yet\n", name, watched.section.iri_mm_per_m);
            continue;
        }
        text += fmt::format("{:<18.18} {:>6.2f} {:>6.2f} {:>+7.2f} ± {:<5.2f} {:>10.0f}  {}\n",
                            name,
                            watched.section.iri_mm_per_m,
                            watched.cars.iri,
                            watched.off,
                            z_of_90_percent * watched.off_sd,
                            watched.cars.length_m,
                            drift_words(watched));
    }
    return text;
}

std::string json_of(const std::vector<WatchedSection>& sections) {
    return array_of(sections);
}

std::string text_of(const std::vector<SurveyUse>& surveys) {
    if (surveys.empty()) {
        return {};
    }
    auto text = fmt::format("\n{:<24} {:<10} {:>8} {:>8} {:>9} {:>9} {:>13}\n",
                            "reference survey",
                            "date",
                            "accuracy",
                            "rows of",
                            "segments",
                            "km",
                            "km, no car");
    for (const auto& survey : surveys) {
        text += fmt::format("{:<24.24} {:<10} {:>6.1f} % {:>6.0f} m {:>9} {:>9.2f} {:>13.2f}\n",
                            printable_name(survey.name),
                            day_of(survey.utc_ms),
                            100 * survey.relative_sd,
                            survey.row_m,
                            survey.passes,
                            survey.km,
                            survey.alone_km);
    }
    return text;
}

std::string json_of(const std::vector<SurveyUse>& surveys) {
    return array_of(surveys);
}

} // namespace macadam
