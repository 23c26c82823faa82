#include "app/serve/filters/cql2_json.hpp"

#include "app/serve/filters/cql2_literals.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using nlohmann::json;
using Kind = Cql2Geometry::Kind;

/// Operators with the number of their operands; 0: two or more.
constexpr std::array<std::pair<std::string_view, std::size_t>, 19> operators{{
    {"and", 0}, {"or", 0}, {"not", 1},  {"=", 2},  {"<>", 2},      {"<", 2},      {">", 2},
    {"<=", 2},  {">=", 2}, {"like", 2}, {"in", 2}, {"between", 3}, {"isNull", 1}, {"+", 2},
    {"-", 2},   {"*", 2},  {"/", 2},    {"%", 2},  {"^", 2},
}};

[[noreturn]] void refuse(const json& value, std::string_view expected) {
    throw Cql2Error{
        fmt::format("there is {}, expected {}",
                    in_quotes(value.dump(-1, ' ', false, json::error_handler_t::replace)),
                    expected)};
}

const json& member(const json& object, const char* name, json::value_t type) {
    const auto found = object.find(name);
    if (found == object.end() || found->type() != type) {
        refuse(object, fmt::format("a member {}", name));
    }
    return *found;
}

// ---------------------------------------------------------------------------------- geometries

std::pair<double, double> position(const json& value) {
    if (!value.is_array() || value.size() < 2 || !value[0].is_number() || !value[1].is_number()) {
        refuse(value, "a position of two numbers");
    }
    return {value[0].get<double>(), value[1].get<double>()};
}

Cql2Line line(const json& value) {
    if (!value.is_array()) {
        refuse(value, "a list of positions");
    }
    Cql2Line line;
    std::ranges::transform(value, std::back_inserter(line), position);
    return line;
}

std::vector<Cql2Line> lines(const json& value) {
    if (!value.is_array()) {
        refuse(value, "a list of lines");
    }
    std::vector<Cql2Line> lines;
    std::ranges::transform(value, std::back_inserter(lines), line);
    return lines;
}

Cql2Geometry geometry(const json& value, bool is_within = false) {
    constexpr std::array<std::pair<std::string_view, Kind>, 7> kinds{{
        {"Point", Kind::point},
        {"LineString", Kind::line},
        {"Polygon", Kind::polygon},
        {"MultiPoint", Kind::multi_point},
        {"MultiLineString", Kind::multi_line},
        {"MultiPolygon", Kind::multi_polygon},
        {"GeometryCollection", Kind::collection},
    }};
    const auto& type = member(value, "type", json::value_t::string).get_ref<const std::string&>();
    const auto* const found =
        std::ranges::find(kinds, type, [](const auto& kind) { return kind.first; });
    if (found == kinds.end() || (is_within && found->second == Kind::collection)) {
        refuse(value, "a geometry of GeoJSON");
    }
    Cql2Geometry made{.kind = found->second};
    const auto& content = member(
        value, made.kind == Kind::collection ? "geometries" : "coordinates", json::value_t::array);
    switch (made.kind) {
    case Kind::point:
        made.lines = {{position(content)}};
        break;
    case Kind::line:
        made.lines = {line(content)};
        break;
    case Kind::multi_point:
        for (const auto& each : content) {
            made.lines.push_back({position(each)});
        }
        break;
    case Kind::multi_polygon:
        for (const auto& each : content) {
            made.parts.push_back({.kind = Kind::polygon, .lines = lines(each)});
        }
        break;
    case Kind::collection:
        for (const auto& each : content) {
            made.parts.push_back(geometry(each, true));
        }
        break;
    default:
        made.lines = lines(content);
    }
    expect_whole(made);
    return made;
}

Cql2Geometry box(const json& value) {
    constexpr std::size_t flat = 4, high = 6;
    const bool is_box =
        value.is_array() && (value.size() == flat || value.size() == high) &&
        std::ranges::all_of(value, [](const json& each) { return each.is_number(); });
    if (!is_box) {
        refuse(value, "4 or 6 numbers");
    }
    const auto half = value.size() / 2;
    return {.kind = Kind::box,
            .lines = {{{value[0].get<double>(), value[1].get<double>()},
                       {value[half].get<double>(), value[half + 1].get<double>()}}}};
}

// --------------------------------------------------------------------------------- expressions

Cql2Expression literal(Cql2Expression::Literal value) {
    return {.op = {}, .args = {}, .literal = std::move(value)};
}

Cql2Border border(const json& value) {
    if (value.is_string()) {
        return parse_cql2_border(value.get_ref<const std::string&>());
    }
    if (!value.is_object()) {
        refuse(value, "a time, \"..\" or a property");
    }
    return Cql2Property{member(value, "property", json::value_t::string)};
}

Cql2Expression instant(const json& value, const char* name) {
    const auto parsed = parse_cql2_instant(
        member(value, name, json::value_t::string).get_ref<const std::string&>());
    if (parsed.is_day != (std::string_view{name} == "date")) {
        refuse(value, "a date without, or a timestamp with a time of day");
    }
    return literal(parsed);
}

Cql2Expression expression(const json& value, int depth);

Cql2Expression list(const json& value, int depth) {
    Cql2Expression made{.op = "list", .args = {}, .literal = {}};
    for (const auto& each : value) {
        made.args.push_back(expression(each, depth));
    }
    return made;
}

Cql2Expression call(const json& value, int depth) {
    const auto& word = member(value, "op", json::value_t::string).get_ref<const std::string&>();
    const auto& args = member(value, "args", json::value_t::array);
    const auto* const known =
        std::ranges::find(operators, word, [](const auto& op) { return op.first; });
    const auto function = cql2_function(word);
    const bool is_div = word == "div";
    if (known == operators.end() && !is_div && !(function && *function == word)) {
        throw Cql2Error{fmt::format("there is no operator or function {}", in_quotes(word))};
    }
    const std::size_t wanted = known != operators.end() ? known->second : word == "casei" ? 1 : 2;
    if (wanted == 0 ? args.size() < 2 : args.size() != wanted) {
        refuse(value, wanted == 0 ? "two operands or more" : fmt::format("{} operands", wanted));
    }
    Cql2Expression made{.op = word, .args = {}, .literal = {}};
    for (const auto& each : args) {
        const bool is_list = word == "in" && !made.args.empty();
        if (each.is_array() != is_list) {
            refuse(value, is_list ? "a list of values" : "operands that are no lists");
        }
        made.args.push_back(is_list ? list(each, depth + 1) : expression(each, depth + 1));
    }
    return made;
}

Cql2Expression expression(const json& value, int depth) {
    if (depth > max_cql2_depth) {
        throw Cql2Error{fmt::format("the filter is nested more than {} deep", max_cql2_depth)};
    }
    if (value.is_boolean()) {
        return literal(value.get<bool>());
    }
    if (value.is_number()) {
        return literal(value.get<double>());
    }
    if (value.is_string()) {
        return literal(value.get<std::string>());
    }
    if (!value.is_object()) {
        refuse(value, "an expression");
    }
    if (value.contains("op")) {
        return call(value, depth);
    }
    if (value.contains("property")) {
        return literal(Cql2Property{member(value, "property", json::value_t::string)});
    }
    if (value.contains("bbox") && !value.contains("type")) {
        return literal(box(value["bbox"]));
    }
    for (const auto* name : {"date", "timestamp"}) {
        if (value.contains(name)) {
            return instant(value, name);
        }
    }
    if (value.contains("interval")) {
        const auto& borders = member(value, "interval", json::value_t::array);
        if (borders.size() != 2) {
            refuse(value, "a beginning and an end");
        }
        return literal(Cql2Interval{border(borders[0]), border(borders[1])});
    }
    return literal(geometry(value));
}

} // namespace

Cql2Expression parse_cql2_json(std::string_view text) {
    if (text.size() > max_cql2_bytes) {
        throw Cql2Error{fmt::format(
            "the filter has {} bytes, expected at most {}", text.size(), max_cql2_bytes)};
    }
    constexpr int deepest = max_cql2_depth + 5; // of a multipolygon's numbers
    const auto value = json::parse(
        text,
        [](int depth, json::parse_event_t, const json&) {
            if (depth > 2 * deepest) { // an object and a list for each operator
                throw Cql2Error{
                    fmt::format("the filter is nested more than {} deep", max_cql2_depth)};
            }
            return true;
        },
        false);
    if (value.is_discarded()) {
        throw Cql2Error{"the filter is not JSON"};
    }
    return expression(value, 1);
}

} // namespace macadam
