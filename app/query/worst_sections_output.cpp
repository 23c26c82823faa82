#include "app/query/worst_sections_output.hpp"

#include "app/cli/row_writer.hpp"
#include "app/query/mean_cells.hpp"
#include "storage/exports/export.hpp"

#include <fmt/format.h>

#include <array>
#include <vector>

namespace macadam {
namespace {

using Row = RankedSection;

/// Formats a linear reference: "123456+ 100.0-240.0", + along the way's own direction, - against
/// it.
std::string linear_reference(const Row& row) {
    std::vector<std::string> parts;
    for (const auto& part : row.section.parts) {
        parts.push_back(fmt::format(
            "{}{} {:.1f}-{:.1f}", part.way_id, part.forward ? '+' : '-', part.from_m, part.to_m));
    }
    return fmt::format("{}", fmt::join(parts, "; "));
}

std::string passes_words(const Row& row) {
    return passes_cell(row.section.min_passes, row.section.median_passes);
}

std::string middle_words(const Row& row) {
    return fmt::format("{:.5f},{:.5f}", row.section.middle.lat_deg, row.section.middle.lon_deg);
}

Cell unless_empty(const std::string& text) {
    return known_if(!text.empty(), text);
}

// clang-format off
const Columns<Row> columns{
    {"rank", as::integer, [](auto& r) { return r.rank; }, {"rank", "{:>4}"}},
    {"name", as::text, [](auto& r) { return unless_empty(r.section.name); }},
    {"highway", as::text, [](auto& r) { return unless_empty(r.section.highway); }},
    {"", as::text,
     [](auto& r) { return r.section.name.empty() ? r.section.highway : r.section.name; },
     {"road", "  {:<26.26}"}},
    {"parts", as::json_only(as::numbers_in("m", as::raw)), [](auto& r) { return parts_json(r.section.parts); }},
    {"way_ids", as::csv_only(as::raw), [](auto& r) { return way_ids_list(r.section.parts); }},
    {"direction", as::csv_only(as::raw), [](auto& r) { return directions_list(r.section.parts); }},
    {"from_m", as::csv_only(as::numbers_in("m", as::raw)),
     [](auto& r) { return metres_list(r.section.parts, &StretchPart::from_m); }},
    {"to_m", as::csv_only(as::numbers_in("m", as::raw)),
     [](auto& r) { return metres_list(r.section.parts, &StretchPart::to_m); }},
    {"length_m", as::metres(2), [](auto& r) { return r.section.length_m; }, {"metres", " {:>7}", 0}},
    {"iri", as::iri(3), [](auto& r) { return r.section.mean.iri; }, {"IRI", " {:>6}", 2}},
    {"iri_low", as::iri(3), [](auto& r) { return r.section.mean.low; }},
    {"iri_high", as::iri(3), [](auto& r) { return r.section.mean.high; }},
    {"", as::numbers_in("mm/m"), [](auto& r) { return interval_text(r.section.mean); }, {"90 %", " {:>13}"}},
    {"iri_worst", as::iri(3), [](auto& r) { return r.section.worst_iri; }, {"worst", " {:>6}", 2}},
    {"passes_least", as::integer, [](auto& r) { return r.section.min_passes; }},
    {"passes_median", as::shortest, [](auto& r) { return r.section.median_passes; }},
    {"", as::text, passes_words, {"passes", " {:>6}"}},
    {"vehicles", as::integer, [](auto& r) { return r.section.vehicles; }, {"cars", " {:>4}"}},
    {"first_seen", as::day, [](auto& r) { return day_cell(r.section.first_seen_ms); }},
    {"last_seen", as::day, [](auto& r) { return day_cell(r.section.last_seen_ms); }},
    {"lat_deg", as::degrees, [](auto& r) { return r.section.middle.lat_deg; }},
    {"lon_deg", as::degrees, [](auto& r) { return r.section.middle.lon_deg; }},
    {"", as::text, middle_words, {"middle", "  {:<20}"}},
    {"", as::numbers_in("m"), linear_reference, {"location along the way", " {}"}},
};
// clang-format on

} // namespace

const Columns<RankedSection>& worst_section_columns() {
    return columns;
}

std::string
stretches_text(std::span<const WorstSection> stretches, std::string_view format, UnitSystem units) {
    std::vector<Row> rows;
    for (const auto& section : stretches) {
        rows.push_back({rows.size() + 1, section});
    }
    const auto in_unit = in_units(columns, units);
    return rows_text(in_unit, rows, format, [&](const Row& row) {
        return geojson_feature(JsonValue{static_cast<std::int64_t>(row.rank)},
                               row.section.line,
                               json_object(in_unit, row));
    });
}

std::string_view heading_of(const WorstSection& stretch) {
    constexpr std::array<std::string_view, 8> points{"N", "NE", "E", "SE", "S", "SW", "W", "NW"};
    const double course = course_deg(stretch.line.front(), stretch.line.back());
    return points[static_cast<std::size_t>((course + 22.5) / 45) % points.size()];
}

} // namespace macadam
