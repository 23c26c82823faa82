#include "app/serve/ogc/items_query.hpp"

#include "app/cli/arguments.hpp"

#include "app/database/segment_options.hpp"
#include "app/database/time_border.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

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
    return box_of({low.lon_deg, low.lat_deg, top.lon_deg, top.lat_deg});
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
    if (is_open || (period.from_ms && period.until_ms && *period.from_ms > *period.until_ms)) {
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
    for (const auto& [name, value] : request.parameters) {
        bool selects = true;
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
        } else if (name == "crs" || name == "f") {
            selects = false;
        } else if (name != "bbox-crs") {
            const auto column = std::ranges::find(columns, name, &FeatureColumn::name);
            if (column == columns.end()) {
                throw UsageError{fmt::format("unknown parameter {}", in_quotes(name))};
            }
            query.tests.emplace_back([&column = *column, value](const Feature& feature) {
                return equals_text(column.type, column.value(feature.row), value);
            });
        }
        query.rest += name == "f" ? "" : pair_text(name, value);
        query.selection += selects ? pair_text(name, value) : "";
    }
    return query;
}

} // namespace macadam
