#include "storage/exports/export.hpp"

#include "mapping/geometry/antimeridian.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/text/json_append.hpp"
#include "storage/text/unit_system.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>

namespace macadam {
namespace {

constexpr int place_decimals = 7; // 1 cm

using Row = ClassedSegment;
using Text = std::optional<std::string>;

Text unless_empty(const std::string& text) {
    return text.empty() ? std::nullopt : Text{text};
}

/// Value of a state; unknown without a pass.
template <typename Member>
Cell of_state(const Row& row, Member member) {
    return row.record.state ? Cell{std::invoke(member, *row.record.state)} : Cell{};
}

template <typename Member>
Cell iri_of(const Row& row, Member member) {
    const std::optional<IriUm> none;
    const auto um = row.record.state ? std::invoke(member, *row.record.state) : none;
    return um ? Cell{mm_per_m(*um)} : Cell{};
}

template <typename Member>
Cell day_of(const Row& row, Member member) {
    const std::optional<std::int64_t> none;
    const auto utc_ms = row.record.state ? std::invoke(member, *row.record.state) : none;
    return utc_ms ? Cell{utc_day(*utc_ms)} : Cell{};
}

/// Value of a state in a table, which shows nothing after "(no pass)".
template <typename Member>
std::string in_table(const Row& row, Member member) {
    return row.record.state ? fmt::format("{}", std::invoke(member, *row.record.state)) : "";
}

std::optional<std::int64_t> changed_ms(const SegmentState& state) {
    return state.change ? std::optional{state.change->utc_ms} : std::nullopt;
}

std::optional<IriUm> change_um(const SegmentState& state) {
    return state.change ? std::optional{state.change->um} : std::nullopt;
}

Cell class_of(const Row& row) {
    return of_state(row, [&](const SegmentState& state) {
        return row.classes.classes[class_index(row.classes, mm_per_m(state.iri_um))].name;
    });
}

std::string road_interval_of(const Row& row) {
    return fmt::format("{:>8.1f}-{:>8.1f}", row.record.segment.from_m, row.record.segment.to_m);
}

Cell iri_interval_of(const Row& row) {
    return of_state(row, [](const SegmentState& state) {
        return fmt::format("{:>5.2f} - {:>5.2f}", mm_per_m(state.low_um), mm_per_m(state.high_um));
    });
}

std::string last_seen_words(const Row& row) {
    const auto& state = row.record.state;
    return !state ? "" : state->last_seen_ms ? utc_day(*state->last_seen_ms) : "undated";
}

/// Point halfway along a segment.
GeoPoint middle_of(const Row& row) {
    const auto& line = row.record.segment.line;
    if (!crosses_antimeridian(line)) {
        return halfway_along(line);
    }
    const auto middle = halfway_along(unwrapped(line, line.front().lon_deg));
    return {middle.lat_deg, std::remainder(middle.lon_deg, 360.0)};
}

void append_positions(std::string& text, std::span<const GeoPoint> line) {
    text += '[';
    const char* separator = "[";
    for (const auto& point : line) {
        text += separator;
        append_fixed(text, point.lon_deg, place_decimals);
        text += ',';
        append_fixed(text, point.lat_deg, place_decimals);
        text += ']';
        separator = ",[";
    }
    text += ']';
}

std::string geometry_of(std::span<const GeoPoint> line) {
    std::string text;
    append_geojson_geometry(text, line);
    return text;
}

using State = SegmentState;

// clang-format off
const Columns<Row> columns{
    {"segment", as::required(as::text),
     [](auto& r) { return name_of(r.record.segment.key); }, {"segment", "{:<18}"}},
    {"way_id", as::required(as::integer), [](auto& r) { return r.record.segment.key.way_id; }},
    {"name", as::text, [](auto& r) { return unless_empty(r.record.name); }},
    {"highway", as::text, [](auto& r) { return unless_empty(r.record.highway); }},
    {"", as::text, [](auto& r) { return r.record.name.empty() ? r.record.highway : r.record.name; },
     {"road", " {:<24.24}"}},
    {"direction", as::required(as::text),
     [](auto& r) { return r.record.segment.key.forward ? "forward" : "backward"; }},
    {"from_m", as::required(as::metres(2)), [](auto& r) { return r.record.segment.from_m; }},
    {"to_m", as::required(as::metres(2)), [](auto& r) { return r.record.segment.to_m; }},
    {"", as::numbers_in("m"), road_interval_of, {"from-to m", " {:>17}"}},
    {"iri", as::iri(3), [](auto& r) { return iri_of(r, &State::iri_um); }, {"IRI", " {:>6}", 2}},
    {"iri_sd", as::iri(3), [](auto& r) { return iri_of(r, &State::sd_um); }},
    {"iri_low", as::iri(3), [](auto& r) { return iri_of(r, &State::low_um); }},
    {"iri_high", as::iri(3), [](auto& r) { return iri_of(r, &State::high_um); }},
    {"", as::numbers_in("mm/m"), iri_interval_of, {"90 %", " {:>13}"}},
    {"iri_left", as::iri(3), [](auto& r) { return iri_of(r, &State::left_um); }},
    {"iri_right", as::iri(3), [](auto& r) { return iri_of(r, &State::right_um); }},
    {"index", as::text,
     [](auto& r) { return of_state(r, [](auto& s) { return name_of_index(s.centre_only); }); }},
    {"class", as::text, class_of},
    {"", as::text, [](auto& r) { return r.record.state ? class_of(r) : Cell{"(no pass)"}; },
     {"class", "  {:<6}"}},
    {"passes", as::required(as::integer),
     [](auto& r) { return r.record.state ? r.record.state->passes : 0; }},
    {"vehicles", as::required(as::integer),
     [](auto& r) { return r.record.state ? r.record.state->vehicles : 0; }},
    {"", as::text, [](auto& r) { return in_table(r, &State::passes); }, {"passes", " {:>6}"}},
    {"", as::text, [](auto& r) { return in_table(r, &State::vehicles); }, {"cars", " {:>5}"}},
    {"first_seen", as::day, [](auto& r) { return day_of(r, &State::first_seen_ms); }},
    {"last_seen", as::day, [](auto& r) { return day_of(r, &State::last_seen_ms); }},
    {"", as::text, last_seen_words, {"last seen", "  {}"}},
    {"trend_per_year", as::iri(3), [](auto& r) { return iri_of(r, &State::trend_um_per_year); }},
    {"trend_sd", as::iri(3), [](auto& r) { return iri_of(r, &State::trend_sd_um_per_year); }},
    {"changed", as::day, [](auto& r) { return day_of(r, changed_ms); }},
    {"change", as::iri(3), [](auto& r) { return iri_of(r, change_um); }},
    {"validity", as::text,
     [](auto& r) { return of_state(r, [](auto& s) { return name_of_validity(s.validity); }); }},
    {"lat_deg", as::csv_only(as::degrees), [](auto& r) { return middle_of(r).lat_deg; }},
    {"lon_deg", as::csv_only(as::degrees), [](auto& r) { return middle_of(r).lon_deg; }},
};
// clang-format on

} // namespace

const Columns<ClassedSegment>& segment_columns() {
    return columns;
}

const Columns<ClassedSegment>& segment_attributes() {
    static const auto attributes = attributes_of(columns);
    return attributes;
}

std::vector<Text> attribute_texts(const ClassedSegment& segment,
                                  const Columns<ClassedSegment>& attributes) {
    std::vector<Text> texts;
    for (const auto& column : attributes) {
        texts.push_back(plain_text(column.type, column.value(segment)));
    }
    return texts;
}

void append_geojson_geometry(std::string& text, std::span<const GeoPoint> line) {
    if (!crosses_antimeridian(line)) {
        text += R"({"type":"LineString","coordinates":)";
        append_positions(text, line);
        text += '}';
        return;
    }
    text += R"({"type":"MultiLineString","coordinates":)";
    const char* separator = "[";
    for (const auto& part : cut_at_antimeridian(line)) {
        text += separator;
        append_positions(text, part);
        separator = ",";
    }
    text += "]}";
}

std::string geojson_feature(const std::optional<JsonValue>& id,
                            const std::vector<GeoPoint>& line,
                            const JsonObject& properties) {
    JsonObject feature;
    feature.add("type", "Feature");
    if (id) {
        feature.add("id", *id);
    }
    feature
        .add("geometry", line.empty() ? JsonValue{nullptr} : JsonValue{JsonRaw{geometry_of(line)}})
        .add("properties", JsonRaw{properties.text()});
    return feature.text();
}

std::string geojson_feature(const ClassedSegment& segment, const Columns<ClassedSegment>& fields) {
    return geojson_feature(name_of(segment.record.segment.key),
                           segment.record.segment.line,
                           json_object(fields, segment));
}

} // namespace macadam
