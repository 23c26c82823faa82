#include "app/query/worst_sections_output.hpp"

#include "app/cli/terminal_escape.hpp"
#include "storage/exports/export.hpp"
#include "storage/text/json.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <array>
#include <functional>
#include <vector>

namespace macadam {
namespace {

constexpr int place_decimals = 7; // 1 cm

/// Lists one value for each way of a section, separated by semicolons.
std::string list_of(const WorstSection& stretch,
                    const std::function<std::string(const StretchPart&)>& text) {
    std::vector<std::string> values;
    for (const auto& part : stretch.parts) {
        values.push_back(text(part));
    }
    return fmt::format("{}", fmt::join(values, ";"));
}

// --------------------------------------------------------------------------------------- table

/// Formats a linear reference: "123456+ 100.0-240.0", + along the way's own direction, - against
/// it.
std::string linear_reference(const WorstSection& stretch) {
    std::vector<std::string> parts;
    for (const auto& part : stretch.parts) {
        parts.push_back(fmt::format(
            "{}{} {:.1f}-{:.1f}", part.way_id, part.forward ? '+' : '-', part.from_m, part.to_m));
    }
    return fmt::format("{}", fmt::join(parts, "; "));
}

std::string table_of(std::span<const WorstSection> stretches) {
    auto table = fmt::format("{:>4}  {:<26} {:>7} {:>6} {:>13} {:>6} {:>6} {:>4}  {:<20} {}\n",
                             "rank",
                             "road",
                             "metres",
                             "IRI",
                             "90 %",
                             "worst",
                             "passes",
                             "cars",
                             "middle",
                             "location along the way");
    std::size_t rank = 0;
    for (const auto& s : stretches) {
        const auto passes = s.min_passes == s.median_passes
                                ? fmt::format("{}", s.min_passes)
                                : fmt::format("{}-{:g}", s.min_passes, s.median_passes);
        table += fmt::format("{:>4}  {:<26.26} {:>7.0f} {:>6.2f} {:>5.2f} - {:>5.2f} {:>6.2f} "
                             "{:>6} {:>4}  {:<20} {}\n",
                             ++rank,
                             printable_name(s.name.empty() ? s.highway : s.name),
                             s.length_m,
                             s.mean.iri,
                             s.mean.low,
                             s.mean.high,
                             s.worst_iri,
                             passes,
                             s.vehicles,
                             fmt::format("{:.5f},{:.5f}", s.middle.lat_deg, s.middle.lon_deg),
                             linear_reference(s));
    }
    return table;
}

// ------------------------------------------------------------------------------------------ CSV

constexpr std::string_view csv_header =
    "rank,name,highway,way_ids,direction,from_m,to_m,length_m,iri,iri_low,iri_high,iri_worst,"
    "passes_least,passes_median,vehicles,first_seen,last_seen,lat_deg,lon_deg\n";

std::string day_cell(const std::optional<std::int64_t>& utc_ms) {
    return utc_ms ? utc_day(*utc_ms) : "";
}

std::string csv_row(const WorstSection& s, std::size_t rank) {
    const auto metres = [&](double StretchPart::*border) {
        return list_of(s,
                       [border](const auto& part) { return fmt::format("{:.2f}", part.*border); });
    };
    return fmt::format(
        "{},{},{},{},{},{},{},{:.2f},{:.3f},{:.3f},{:.3f},{:.3f},{},{},{},{},{},{:.{}f},{:.{}f}\n",
        rank,
        csv_text(s.name),
        csv_text(s.highway),
        list_of(s, [](const auto& part) { return fmt::format("{}", part.way_id); }),
        list_of(
            s, [](const auto& part) { return std::string{part.forward ? "forward" : "backward"}; }),
        metres(&StretchPart::from_m),
        metres(&StretchPart::to_m),
        s.length_m,
        s.mean.iri,
        s.mean.low,
        s.mean.high,
        s.worst_iri,
        s.min_passes,
        s.median_passes,
        s.vehicles,
        day_cell(s.first_seen_ms),
        day_cell(s.last_seen_ms),
        s.middle.lat_deg,
        place_decimals,
        s.middle.lon_deg,
        place_decimals);
}

std::string csv_of(std::span<const WorstSection> stretches) {
    std::string csv{csv_header};
    for (std::size_t i = 0; i < stretches.size(); ++i) {
        csv += csv_row(stretches[i], i + 1);
    }
    return csv;
}

// --------------------------------------------------------------------------------- JSON, GeoJSON

JsonValue text_or_null(const std::string& text) {
    return text.empty() ? JsonValue{nullptr} : JsonValue{text};
}

std::string json_parts(const WorstSection& stretch) {
    std::vector<std::string> parts;
    for (const auto& part : stretch.parts) {
        JsonObject object;
        object.add("way_id", part.way_id)
            .add("direction", std::string{part.forward ? "forward" : "backward"})
            .add("from_m", JsonNumber{part.from_m, 2})
            .add("to_m", JsonNumber{part.to_m, 2});
        parts.push_back(object.text());
    }
    return json_array(parts);
}

std::string json_object_of(const WorstSection& s, std::size_t rank) {
    JsonObject object;
    object.add("rank", static_cast<std::int64_t>(rank))
        .add("name", text_or_null(s.name))
        .add("highway", text_or_null(s.highway))
        .add("parts", JsonRaw{json_parts(s)})
        .add("length_m", JsonNumber{s.length_m, 2})
        .add("iri", JsonNumber{s.mean.iri, 3})
        .add("iri_low", JsonNumber{s.mean.low, 3})
        .add("iri_high", JsonNumber{s.mean.high, 3})
        .add("iri_worst", JsonNumber{s.worst_iri, 3})
        .add("passes_least", std::int64_t{s.min_passes})
        .add("passes_median", JsonRaw{fmt::format("{}", s.median_passes)})
        .add("vehicles", std::int64_t{s.vehicles})
        .add("first_seen", text_or_null(day_cell(s.first_seen_ms)))
        .add("last_seen", text_or_null(day_cell(s.last_seen_ms)))
        .add("lat_deg", JsonNumber{s.middle.lat_deg, place_decimals})
        .add("lon_deg", JsonNumber{s.middle.lon_deg, place_decimals});
    return object.text();
}

std::string json_of(std::span<const WorstSection> stretches) {
    std::vector<std::string> objects;
    for (std::size_t i = 0; i < stretches.size(); ++i) {
        objects.push_back(json_object_of(stretches[i], i + 1));
    }
    return json_array(objects) + "\n";
}

std::string geojson_feature(const WorstSection& stretch, std::size_t rank) {
    JsonObject feature;
    feature.add("type", "Feature")
        .add("id", static_cast<std::int64_t>(rank))
        .add("geometry", JsonRaw{geojson_geometry(stretch.line)})
        .add("properties", JsonRaw{json_object_of(stretch, rank)});
    return feature.text();
}

std::string geojson_of(std::span<const WorstSection> stretches) {
    std::vector<std::string> features;
    for (std::size_t i = 0; i < stretches.size(); ++i) {
        features.push_back(geojson_feature(stretches[i], i + 1));
    }
    JsonObject collection;
    collection.add("type", "FeatureCollection").add("features", JsonRaw{json_array(features)});
    return collection.text() + "\n";
}

} // namespace

std::string stretches_text(std::span<const WorstSection> stretches, std::string_view format) {
    if (format == "json") {
        return json_of(stretches);
    }
    if (format == "csv") {
        return csv_of(stretches);
    }
    return format == "geojson" ? geojson_of(stretches) : table_of(stretches);
}

std::string_view heading_of(const WorstSection& stretch) {
    constexpr std::array<std::string_view, 8> points{"N", "NE", "E", "SE", "S", "SW", "W", "NW"};
    const double course = course_deg(stretch.line.front(), stretch.line.back());
    return points[static_cast<std::size_t>((course + 22.5) / 45) % points.size()];
}

} // namespace macadam
