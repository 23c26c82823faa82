#include "mapping/network/segment.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/exact_number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

namespace macadam {
namespace {

/// Returns the position `at_m` from the way's first node, which lies on the link.
GeoPoint place_at(const RoadNetwork& roads, const Link& link, double at_m) {
    const auto way = way_at(roads, link.way);
    const auto& along_m = way.along_m;
    const auto& line = way.line;
    const auto next = std::ranges::upper_bound(
        along_m.begin() + link.first_point + 1, along_m.begin() + link.last_point, at_m);
    const auto i = static_cast<std::size_t>(next - along_m.begin());
    const double step_m = along_m[i] - along_m[i - 1];
    return between(line[i - 1], line[i], step_m > 0 ? (at_m - along_m[i - 1]) / step_m : 0.0);
}

/// Returns the boundary between segments `number` - 1 and `number` of the link, from the way's
/// first node.
double border_m(const Link& link, std::uint32_t number) {
    return number == link.segments
               ? link.to_m
               : link.from_m + (link.to_m - link.from_m) * number / link.segments;
}

std::vector<GeoPoint>
line_between(const RoadNetwork& roads, const Link& link, double from_m, double to_m) {
    const auto way = way_at(roads, link.way);
    const auto& along_m = way.along_m;
    std::vector<GeoPoint> line{place_at(roads, link, from_m)};
    const auto last = along_m.begin() + link.last_point;
    auto point = std::ranges::upper_bound(along_m.begin() + link.first_point + 1, last, from_m);
    for (; point != last && *point < to_m; ++point) {
        const auto i = static_cast<std::size_t>(point - along_m.begin());
        line.push_back(way.line[i]);
    }
    line.push_back(place_at(roads, link, to_m));
    return line;
}

} // namespace

std::string name_of(const SegmentKey& key) {
    constexpr std::size_t min_digits = 4;
    std::array<char, 32> name{}; // 20 characters for the way, a sign, 10 for the index
    std::array<char, 10> index{};
    auto* const way_end = std::to_chars(name.data(), name.data() + 20, key.way_id).ptr;
    const auto* const index_end =
        std::to_chars(index.data(), index.data() + index.size(), key.index).ptr;
    const auto digits = static_cast<std::size_t>(index_end - index.data());
    auto* at = way_end;
    *at++ = key.forward ? '+' : '-';
    at = std::fill_n(at, min_digits - std::min(digits, min_digits), '0');
    at = std::copy_n(index.data(), digits, at);
    return {name.data(), at};
}

SegmentKey parse_segment_key(std::string_view text) {
    const auto sign = text.find_last_of("+-");
    if (sign != std::string_view::npos && text.size() - sign - 1 >= 4) {
        const auto way_id = exact_number<std::int64_t>(text.substr(0, sign));
        const auto index = exact_number<std::uint32_t>(text.substr(sign + 1));
        if (way_id && index) {
            return {*way_id, text[sign] == '+', *index};
        }
    }
    throw InputError{
        fmt::format("'{}' is not a segment, expected a key such as 123456+0007", text)};
}

std::vector<Segment> segments_of(const RoadNetwork& roads, EdgeId edge) {
    const auto link = link_at(roads, edge);
    const bool forward = is_forward(edge);
    std::vector<Segment> segments;
    segments.reserve(link.segments);
    for (std::uint32_t i = 0; i < link.segments; ++i) {
        const double from_m = border_m(link, i);
        const double to_m = border_m(link, i + 1);
        segments.push_back({{way_at(roads, link.way).id, forward, link.first_segment + i},
                            from_m,
                            to_m,
                            line_between(roads, link, from_m, to_m)});
    }
    if (!forward) {
        std::reverse(segments.begin(), segments.end());
        for (auto& segment : segments) {
            std::reverse(segment.line.begin(), segment.line.end());
        }
    }
    return segments;
}

std::vector<GeoPoint> line_on(const RoadNetwork& roads, EdgeId edge, double from_m, double to_m) {
    const auto link = link_at(roads, edge);
    if (is_forward(edge)) {
        return line_between(roads, link, link.from_m + from_m, link.from_m + to_m);
    }
    auto line = line_between(roads, link, link.to_m - to_m, link.to_m - from_m);
    std::reverse(line.begin(), line.end());
    return line;
}

} // namespace macadam
