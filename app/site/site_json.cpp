#include "app/site/site_json.hpp"

#include "app/query/worst_sections_output.hpp"
#include "storage/exports/export.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/text/columns.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace macadam {
namespace {

constexpr int degree_decimals = 6; // 11 cm

std::string line_json(std::span<const GeoPoint> line) {
    std::vector<std::string> points;
    points.reserve(line.size());
    for (const auto& point : line) {
        points.push_back(fmt::format(
            "[{:.{}f},{:.{}f}]", point.lon_deg, degree_decimals, point.lat_deg, degree_decimals));
    }
    return json_array(points);
}

// clang-format off
const Columns<SegmentMonth> month_columns{
    {"month", as::text, [](auto& r) { return r.month; }},
    {"iri", as::iri(3), [](auto& r) { return mm_per_m(r.state.iri_um); }},
    {"iri_sd", as::iri(3), [](auto& r) { return mm_per_m(r.state.sd_um); }},
    {"iri_low", as::iri(3), [](auto& r) { return mm_per_m(r.state.low_um); }},
    {"iri_high", as::iri(3), [](auto& r) { return mm_per_m(r.state.high_um); }},
    {"passes", as::integer, [](auto& r) { return r.state.passes; }},
    {"vehicles", as::integer, [](auto& r) { return r.state.vehicles; }},
};
// clang-format on

/// Returns the plural form of each number from 0 to 199, a digit each: those of larger numbers
/// depend on their last two digits.
std::string plural_forms(const PluralRule& rule) {
    constexpr std::size_t numbers = 200;
    std::string digits;
    for (std::size_t n = 0; n < numbers; ++n) {
        digits += std::to_string(rule.form(n));
    }
    return digits;
}

/// Beginnings of the keys of messages that the page shares with the report.
constexpr std::array<std::string_view, 11> shared_keys{"site.",
                                                       "locale.",
                                                       "class.",
                                                       "kind.",
                                                       "unnamed.",
                                                       "heading.",
                                                       "range.",
                                                       "cars",
                                                       "trips",
                                                       "title",
                                                       "period"};

} // namespace

std::string segment_json(const SegmentRecord& record,
                         const ClassTable& classes,
                         std::span<const SegmentMonth> months) {
    auto object = json_object<ClassedSegment>(segment_attributes(), {record, classes});
    object.add("line", JsonRaw{line_json(record.segment.line)});
    object.add("months", JsonRaw{json_rows(month_columns, months)});
    return object.text();
}

std::string worst_json(std::span<const WorstSection> sections,
                       std::span<const SegmentRecord> records) {
    std::vector<std::string> rows;
    for (const auto& section : sections) {
        auto object =
            json_object<RankedSection>(worst_section_columns(), {rows.size() + 1, section});
        std::vector<std::string> segments;
        for (const auto index : section.records) {
            segments.push_back(name_of(records[index].segment.key));
        }
        object.add("heading", std::string{heading_of(section)});
        object.add("bounds", JsonRaw{box_json(box_around(section.line))});
        object.add("line", JsonRaw{line_json(section.line)});
        object.add("segments", JsonRaw{json_string_array(segments)});
        rows.push_back(object.text());
    }
    return json_array(rows);
}

std::string words_json(const Language& language) {
    JsonObject object;
    object.add("language", language.code);
    object.add("plural_forms", plural_forms(language.plural));
    for (const auto& [key, forms] : language.messages) {
        const auto is_shared = [&](auto begin) { return key.starts_with(begin); };
        if (std::ranges::none_of(shared_keys, is_shared)) {
            continue;
        }
        for (std::size_t i = 0; i < forms.size(); ++i) {
            object.add(forms.size() == 1 ? key : fmt::format("{}.{}", key, i), forms[i]);
        }
    }
    return object.text();
}

std::string box_json(const GeoBox& box) {
    return fmt::format(
        "[{:.6f},{:.6f},{:.6f},{:.6f}]", box.west_deg, box.south_deg, box.east_deg, box.north_deg);
}

GeoBox box_around(std::span<const GeoPoint> line) {
    GeoBox box;
    for (const auto& [lat_deg, lon_deg] : line) {
        box = joined_box(box, {lon_deg, lat_deg, lon_deg, lat_deg});
    }
    return box;
}

GeoBox joined_box(const GeoBox& a, const GeoBox& b) {
    return {.west_deg = std::min(a.west_deg, b.west_deg),
            .south_deg = std::min(a.south_deg, b.south_deg),
            .east_deg = std::max(a.east_deg, b.east_deg),
            .north_deg = std::max(a.north_deg, b.north_deg)};
}

} // namespace macadam
