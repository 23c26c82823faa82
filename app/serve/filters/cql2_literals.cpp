#include "app/serve/filters/cql2_literals.hpp"

#include "estimator/common/ascii.hpp"
#include "storage/text/text.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace macadam {
namespace {

constexpr std::array<std::string_view, 24> functions{
    "s_contains", "s_crosses",      "s_disjoint",   "s_equals",    "s_intersects", "s_overlaps",
    "s_touches",  "s_within",       "t_after",      "t_before",    "t_contains",   "t_disjoint",
    "t_during",   "t_equals",       "t_finishedBy", "t_finishes",  "t_intersects", "t_meets",
    "t_metBy",    "t_overlappedBy", "t_overlaps",   "t_startedBy", "t_starts",     "casei"};

void expect_positions(const Cql2Line& line, std::size_t least, std::string_view what) {
    if (line.size() < least) {
        throw Cql2Error{
            fmt::format("{} has {} positions, expected {} or more", what, line.size(), least)};
    }
}

} // namespace

Cql2Instant parse_cql2_instant(std::string_view text) {
    constexpr std::size_t day_letters = 10; // "2026-05-01"
    const bool is_day = text.size() == day_letters;
    const auto utc_s = parse_utc_s(is_day ? fmt::format("{}T00:00:00Z", text) : std::string{text});
    constexpr std::size_t after_day = day_letters;
    if (!utc_s || (!is_day && (text.size() <= after_day || text[after_day] != 'T'))) {
        throw Cql2Error{
            fmt::format("{} is no time, expected one such as 2026-05-01 or 2026-05-01T06:00:00Z",
                        in_quotes(text))};
    }
    return {std::llround(*utc_s * 1000), is_day};
}

Cql2Border parse_cql2_border(std::string_view text) {
    return text == ".." ? Cql2Border{} : Cql2Border{parse_cql2_instant(text)};
}

std::optional<std::string_view> cql2_function(std::string_view word) {
    const auto lower = in_lower_case(word);
    const auto* const found = std::ranges::find_if(
        functions, [&](std::string_view name) { return in_lower_case(name) == lower; });
    return found == functions.end() ? std::nullopt : std::optional{*found};
}

void expect_whole(const Cql2Geometry& geometry) {
    using Kind = Cql2Geometry::Kind;
    constexpr std::size_t line_least = 2, ring_least = 4;
    for (const auto& line : geometry.lines) {
        switch (geometry.kind) {
        case Kind::line:
        case Kind::multi_line:
        case Kind::box:
            expect_positions(line, line_least, "a line");
            break;
        case Kind::polygon:
            expect_positions(line, ring_least, "a ring of a polygon");
            if (line.front() != line.back()) {
                throw Cql2Error{"a ring of a polygon does not end where it begins"};
            }
            break;
        default:
            if (line.size() != 1) {
                throw Cql2Error{"a point is not of one position"};
            }
        }
    }
    const bool is_of_parts =
        geometry.kind == Kind::multi_polygon || geometry.kind == Kind::collection;
    if (is_of_parts ? geometry.parts.empty() : geometry.lines.empty()) {
        throw Cql2Error{"a geometry is empty"};
    }
    for (const auto& part : geometry.parts) {
        expect_whole(part);
    }
}

} // namespace macadam
