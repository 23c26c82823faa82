#include "app/serve/ogc/items_query.hpp"

#include "app/cli/arguments.hpp"
#include "app/database/time_border.hpp"
#include "app/serve/filters/cql2_json.hpp"
#include "app/serve/filters/cql2_text.hpp"
#include "app/serve/filters/feature_filter.hpp"
#include "app/serve/ogc/api_context.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

std::size_t parse_count(std::string_view name, const std::string& text, std::size_t least) {
    std::size_t count = 0;
    const auto* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, count);
    if (error != std::errc{} || stop != end || count < least) {
        throw UsageError{fmt::format(
            "{} is {}, expected a whole number from {} on", name, in_quotes(text), least)};
    }
    return count;
}

CoordinateReference parse_uri(std::string_view name, const std::string& text) {
    const auto crs = parse_coordinate_reference(text);
    if (!crs) {
        throw UsageError{fmt::format("{} is {}, expected one of {}",
                                     name,
                                     in_quotes(text),
                                     fmt::join(coordinate_reference_uris, ", "))};
    }
    return *crs;
}

std::vector<double> parse_numbers(const std::string& text) {
    std::vector<double> numbers;
    std::string_view rest = text;
    while (true) {
        const auto word = rest.substr(0, rest.find(','));
        const auto number = parse_number(word);
        if (!number || !std::isfinite(*number)) {
            throw UsageError{fmt::format("bbox has {}, expected a number", in_quotes(word))};
        }
        numbers.push_back(*number);
        if (word.size() == rest.size()) {
            return numbers;
        }
        rest.remove_prefix(word.size() + 1);
    }
}

GeoBox parse_bbox(const std::string& text, CoordinateReference crs) {
    const auto numbers = parse_numbers(text);
    constexpr std::size_t flat = 4, high = 6; // with heights, which say nothing of roads
    if (numbers.size() != flat && numbers.size() != high) {
        throw UsageError{fmt::format("bbox has {} numbers, expected 4 or 6", numbers.size())};
    }
    const auto half = numbers.size() / 2;
    const auto low = geo_point_of(crs, numbers[0], numbers[1]);
    const auto top = geo_point_of(crs, numbers[half], numbers[half + 1]);
    const auto is_on_globe = [](const GeoPoint& point) {
        return std::abs(point.lat_deg) <= 90 && std::abs(point.lon_deg) <= 180;
    };
    if (!is_on_globe(low) || !is_on_globe(top) || low.lat_deg > top.lat_deg) {
        throw UsageError{fmt::format("bbox is {}, expected west, south, east and north on the "
                                     "globe; west > east crosses the antimeridian",
                                     in_quotes(text))};
    }
    constexpr double least_deg = 1e-9; // 0.1 mm: a box without a width or height is a place, too
    const double east_deg = low.lon_deg > top.lon_deg ? top.lon_deg + 360 : top.lon_deg;
    return {low.lon_deg,
            low.lat_deg,
            std::max(east_deg, low.lon_deg + least_deg),
            std::max(top.lat_deg, low.lat_deg + least_deg)};
}

/// Adds the condition of the parameters filter, filter-lang and filter-crs.
void add_filter(const HttpRequest& request,
                std::span<const FeatureColumn> columns,
                ItemsQuery& query) {
    const auto language = request.parameter("filter-lang").value_or("cql2-text");
    const auto uri = request.parameter("filter-crs");
    const auto crs = uri ? parse_uri("filter-crs", *uri) : CoordinateReference::crs84;
    if (language != "cql2-text" && language != "cql2-json") {
        throw UsageError{
            fmt::format("filter-lang is {}, expected cql2-text or cql2-json", in_quotes(language))};
    }
    const auto text = request.parameter("filter");
    if (!text) {
        return;
    }
    try {
        const auto expression =
            language == "cql2-text" ? parse_cql2_text(*text) : parse_cql2_json(*text);
        auto filter = feature_filter(expression, columns, crs);
        query.tests.push_back(std::move(filter.test));
        if (filter.box && !query.box) {
            constexpr double margin_m = 1; // the filter itself decides
            query.box = grown(*filter.box, margin_m);
        }
    } catch (const Cql2Error& error) {
        throw UsageError{fmt::format("filter: {}", error.what())};
    }
}

bool is_among(std::string_view name, std::initializer_list<std::string_view> names) {
    return std::ranges::find(names, name) != names.end();
}

FeatureTest equality(const std::string& name,
                     const std::string& value,
                     std::span<const FeatureColumn> columns) {
    const auto column = std::ranges::find(columns, name, &FeatureColumn::name);
    if (column == columns.end()) {
        throw UsageError{fmt::format("unknown parameter {}", in_quotes(name))};
    }
    return [&column = *column, value](const Feature& feature) {
        return equals_text(column.type, column.value(feature.row), value);
    };
}

std::string pair_text(std::string_view name, std::string_view value) {
    return fmt::format("&{}={}", percent_encoded(name), percent_encoded(value));
}

} // namespace

Period parse_datetime(const std::string& text) {
    const auto slash = text.find('/');
    const auto border = [&](const std::string& word, bool is_end) -> std::optional<std::int64_t> {
        if (word.empty() || word == "..") {
            return std::nullopt;
        }
        const auto ms = time_border_ms(word, is_end);
        if (!ms) {
            throw UsageError{fmt::format("datetime has {}, expected a time such as 2026-05-01 or "
                                         "2026-05-01T06:00:00Z, or an interval of two",
                                         in_quotes(word))};
        }
        return ms;
    };
    if (slash == std::string::npos) { // a time means its day: values are told by days
        constexpr std::size_t day_letters = 10;
        static_cast<void>(border(text, false));
        return {border(text.substr(0, day_letters), false),
                border(text.substr(0, day_letters), true)};
    }
    const Period period{border(text.substr(0, slash), false), border(text.substr(slash + 1), true)};
    const bool is_open = !period.from_ms && !period.until_ms;
    const auto last_begins_ms = border(text.substr(slash + 1), false);
    if (is_open || (period.from_ms && last_begins_ms && *period.from_ms > *last_begins_ms)) {
        throw UsageError{
            fmt::format("datetime is {}, expected a beginning before an end", in_quotes(text))};
    }
    return period;
}

CoordinateReference parse_crs(const HttpRequest& request) {
    const auto crs = request.parameter("crs");
    return crs ? parse_uri("crs", *crs) : CoordinateReference::crs84;
}

ItemsQuery parse_items_query(const HttpRequest& request, std::span<const FeatureColumn> columns) {
    ItemsQuery query;
    query.crs = parse_crs(request);
    const auto bbox_crs = request.parameter("bbox-crs");
    const auto box_reference =
        bbox_crs ? parse_uri("bbox-crs", *bbox_crs) : CoordinateReference::crs84;
    expect_single(request);
    for (const auto& [name, value] : request.parameters) {
        if (name == "limit") {
            query.limit = std::min(parse_count(name, value, 1), max_limit);
            continue;
        }
        if (name == "offset") {
            query.offset = parse_count(name, value, 0);
            continue;
        }
        if (name == "after") {
            query.after = value;
            continue;
        }
        if (name == "bbox") {
            query.box = parse_bbox(value, box_reference);
        } else if (name == "datetime") {
            query.period = parse_datetime(value);
        } else if (!is_among(name,
                             {"crs", "f", "bbox-crs", "filter", "filter-lang", "filter-crs"})) {
            query.tests.push_back(equality(name, value, columns));
        }
        query.rest += name == "f" ? "" : pair_text(name, value);
        query.selection += is_among(name, {"crs", "f"}) ? "" : pair_text(name, value);
    }
    add_filter(request, columns, query);
    return query;
}

} // namespace macadam
