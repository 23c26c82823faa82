#include "storage/exports/export.hpp"

#include "mapping/geometry/antimeridian.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/text/json.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace macadam {
namespace {

using Type = Field::Type;

constexpr int place_decimals = 7; // 1 cm

constexpr std::array fields{
    Field{"segment", Type::text, 0},     Field{"way_id", Type::integer, 0},
    Field{"name", Type::text, 0},        Field{"highway", Type::text, 0},
    Field{"direction", Type::text, 0},   Field{"from_m", Type::real, 2},
    Field{"to_m", Type::real, 2},        Field{"iri", Type::real, 3},
    Field{"iri_sd", Type::real, 3},      Field{"iri_low", Type::real, 3},
    Field{"iri_high", Type::real, 3},    Field{"iri_left", Type::real, 3},
    Field{"iri_right", Type::real, 3},   Field{"index", Type::text, 0},
    Field{"class", Type::text, 0},       Field{"passes", Type::integer, 0},
    Field{"vehicles", Type::integer, 0}, Field{"first_seen", Type::text, 0},
    Field{"last_seen", Type::text, 0},   Field{"trend_per_year", Type::real, 3},
    Field{"trend_sd", Type::real, 3},    Field{"changed", Type::text, 0},
    Field{"change", Type::real, 3},      Field{"validity", Type::text, 0}};

using Text = std::optional<std::string>;

Text unless_empty(const std::string& text) {
    return text.empty() ? std::nullopt : Text{text};
}

Text um_text(const std::optional<IriUm>& um) {
    return um ? Text{fmt::format("{:.3f}", mm_per_m(*um))} : std::nullopt;
}

Text day_text(const std::optional<std::int64_t>& utc_ms) {
    return utc_ms ? Text{utc_day(*utc_ms)} : std::nullopt;
}

/// Values of the fields from `iri` on, in their order.
std::vector<Text> state_values(const SegmentState& state, const ClassTable& classes) {
    return {um_text(state.iri_um),
            um_text(state.sd_um),
            um_text(state.low_um),
            um_text(state.high_um),
            um_text(state.left_um),
            um_text(state.right_um),
            name_of_index(state.centre_only),
            std::string{classes.classes[class_index(classes, mm_per_m(state.iri_um))].name},
            fmt::format("{}", state.passes),
            fmt::format("{}", state.vehicles),
            day_text(state.first_seen_ms),
            day_text(state.last_seen_ms),
            um_text(state.trend_um_per_year),
            um_text(state.trend_sd_um_per_year),
            state.change ? day_text(state.change->utc_ms) : std::nullopt,
            state.change ? um_text(state.change->um) : std::nullopt,
            name_of_validity(state.validity)};
}

std::vector<Text> values_without_state() {
    std::vector<Text> values(17);
    values[8] = values[9] = "0"; // passes and vehicles: 0 is a known value
    return values;
}

std::string positions_of(const std::vector<GeoPoint>& line) {
    std::vector<std::string> points;
    points.reserve(line.size());
    for (const auto& point : line) {
        points.push_back(fmt::format(
            "[{:.{}f},{:.{}f}]", point.lon_deg, place_decimals, point.lat_deg, place_decimals));
    }
    return json_array(points);
}

JsonValue json_of(const Field& field, const Text& value) {
    if (!value) {
        return nullptr;
    }
    return field.type == Type::text ? JsonValue{*value} : JsonValue{JsonRaw{*value}};
}

GeoPoint middle_of(const std::vector<GeoPoint>& line) {
    if (!crosses_antimeridian(line)) {
        return halfway_along(line);
    }
    const auto middle = halfway_along(unwrapped(line, line.front().lon_deg));
    return {middle.lat_deg, std::remainder(middle.lon_deg, 360.0)};
}

/// Tests for text that a spreadsheet would interpret as a formula, even in quotes.
bool looks_like_formula(std::string_view text) {
    return text.find_first_of("=+-@\t\r") == 0;
}

std::string quoted_cell(std::string_view text) {
    std::string cell{"\""};
    for (const char c : text) {
        cell += c == '"' ? "\"\"" : std::string(1, c);
    }
    return cell + "\"";
}

std::string csv_cell(const Field& field, const Text& value) {
    return field.type == Type::text ? csv_text(value.value_or("")) : value.value_or("");
}

} // namespace

std::span<const Field> segment_fields() {
    return fields;
}

bool is_day(const Field& field) {
    return field.name == "first_seen" || field.name == "last_seen" || field.name == "changed";
}

std::vector<Text> field_values(const SegmentRecord& record, const ClassTable& classes) {
    const auto& segment = record.segment;
    std::vector<Text> values{name_of(segment.key),
                             fmt::format("{}", segment.key.way_id),
                             unless_empty(record.name),
                             unless_empty(record.highway),
                             segment.key.forward ? "forward" : "backward",
                             fmt::format("{:.2f}", segment.from_m),
                             fmt::format("{:.2f}", segment.to_m)};
    const auto state = record.state ? state_values(*record.state, classes) : values_without_state();
    values.insert(values.end(), state.begin(), state.end());
    return values;
}

std::string geojson_geometry(const std::vector<GeoPoint>& line) {
    JsonObject geometry;
    if (!crosses_antimeridian(line)) {
        geometry.add("type", "LineString").add("coordinates", JsonRaw{positions_of(line)});
        return geometry.text();
    }
    std::vector<std::string> parts;
    for (const auto& part : cut_at_antimeridian(line)) {
        parts.push_back(positions_of(part));
    }
    geometry.add("type", "MultiLineString").add("coordinates", JsonRaw{json_array(parts)});
    return geometry.text();
}

std::string geojson_feature(const SegmentRecord& record, const ClassTable& classes) {
    const auto values = field_values(record, classes);
    JsonObject properties;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        properties.add(fields[i].name, json_of(fields[i], values[i]));
    }
    JsonObject feature;
    feature.add("type", "Feature")
        .add("id", name_of(record.segment.key))
        .add("geometry", JsonRaw{geojson_geometry(record.segment.line)})
        .add("properties", JsonRaw{properties.text()});
    return feature.text();
}

std::string csv_row(const SegmentRecord& record, const ClassTable& classes) {
    const auto values = field_values(record, classes);
    std::string row;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        row += csv_cell(fields[i], values[i]) + ",";
    }
    const auto middle = middle_of(record.segment.line);
    return row +
           fmt::format(
               "{:.{}f},{:.{}f}", middle.lat_deg, place_decimals, middle.lon_deg, place_decimals);
}

std::string csv_header() {
    std::string header;
    for (const auto& field : fields) {
        header += fmt::format("{},", field.name);
    }
    return header + "lat_deg,lon_deg";
}

std::string csv_text(std::string_view text) {
    if (looks_like_formula(text)) {
        return quoted_cell(fmt::format("'{}", text)); // prefix with which spreadsheets mark text
    }
    const bool plain = text.find_first_of(",\"\r\n") == std::string_view::npos;
    return plain ? std::string{text} : quoted_cell(text);
}

} // namespace macadam
