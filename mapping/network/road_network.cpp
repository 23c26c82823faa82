#include "mapping/network/road_network.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace macadam {
namespace {

constexpr double cm_per_m = 100;

std::string_view text(const RoadNetwork& roads, std::uint32_t number) {
    const auto first = roads.first_letter[number];
    return {roads.letters.data() + first, roads.first_letter[number + 1] - first};
}

/// Returns the index in RoadNetwork::points of the link's last point.
std::uint32_t last_point(const RoadNetwork& roads, std::uint32_t link) {
    const auto way = roads.links[link].way;
    const auto& next = roads.links[link + 1];
    return next.way == way ? next.first_point : roads.ways[way + 1].first_point - 1;
}

} // namespace

PackedPoint packed(const GeoPoint& place) {
    return {static_cast<std::int32_t>(std::lround(place.lat_deg * Unpacked::per_deg)),
            static_cast<std::int32_t>(std::lround(place.lon_deg * Unpacked::per_deg))};
}

std::uint32_t segments_in(double link_m, double segment_length_m) {
    constexpr double most = std::numeric_limits<std::uint32_t>::max();
    return static_cast<std::uint32_t>(std::clamp(std::round(link_m / segment_length_m), 1.0, most));
}

WayView way_at(const RoadNetwork& roads, std::uint32_t way) {
    const auto& found = roads.ways[way];
    const auto& next = roads.ways[way + 1];
    const auto points = next.first_point - found.first_point;
    return {.id = found.id,
            .name = text(roads, found.name),
            .highway = text(roads, found.highway),
            .oneway = static_cast<Oneway>(found.oneway),
            .speed_limit_cmps = found.speed_limit_cmps,
            .node_ids = roads.node_ids.subspan(found.first_point, points),
            .line = PointRange{roads.points.subspan(found.first_point, points), {}},
            .along_m = LengthRange{roads.along_mm.subspan(found.first_point, points), {}},
            .turns = roads.turns.subspan(found.first_turn, next.first_turn - found.first_turn),
            .first_link = found.first_link,
            .past_link = next.first_link};
}

WayView way_of(const RoadNetwork& roads, LinkId link) {
    return way_at(roads, roads.links[static_cast<std::uint32_t>(link)].way);
}

WayView way_of(const RoadNetwork& roads, EdgeId edge) {
    return way_of(roads, link_of(edge));
}

Link link_at(const RoadNetwork& roads, LinkId link) {
    const auto number = static_cast<std::uint32_t>(link);
    const auto& found = roads.links[number];
    const auto first_of_way = roads.ways[found.way].first_point;
    const auto last = last_point(roads, number);
    const double length_m = Unpacked{}(found.length_mm);
    return {.way = found.way,
            .from = NodeId{found.from},
            .to = NodeId{found.to},
            .first_point = found.first_point - first_of_way,
            .last_point = last - first_of_way,
            .from_m = Unpacked{}(roads.along_mm[found.first_point]),
            .to_m = Unpacked{}(roads.along_mm[last]),
            .forward = (found.flags & link_flags::forward) != 0,
            .backward = (found.flags & link_flags::backward) != 0,
            .first_segment = found.first_segment,
            .segments = segments_in(length_m, roads.segment_length_m)};
}

Link link_at(const RoadNetwork& roads, EdgeId edge) {
    return link_at(roads, link_of(edge));
}

Way copy_of(const WayView& way) {
    return {.id = way.id,
            .name = std::string{way.name},
            .highway = std::string{way.highway},
            .oneway = way.oneway,
            .node_ids = {way.node_ids.begin(), way.node_ids.end()},
            .line = {way.line.begin(), way.line.end()},
            .speed_limit_cmps = way.speed_limit_cmps,
            .turns = {way.turns.begin(), way.turns.end()}};
}

std::vector<Way> copies_of_ways(const RoadNetwork& roads) {
    std::vector<Way> ways;
    for (std::uint32_t i = 0; i < way_count(roads); ++i) {
        ways.push_back(copy_of(way_at(roads, i)));
    }
    return ways;
}

GeoPoint place_of(const RoadNetwork& roads, NodeId node) {
    return Unpacked{}(roads.points[roads.node_point[static_cast<std::uint32_t>(node)]]);
}

bool may_turn(const RoadNetwork& roads, EdgeId from, EdgeId to) {
    const auto flag = is_forward(from) ? link_flags::forward_barred : link_flags::backward_barred;
    return (packed_link(roads, from).flags & flag) == 0 ||
           !std::ranges::binary_search(
               roads.turn_restrictions,
               PackedTurn{static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(to)});
}

double speed_limit_mps(const RoadNetwork& roads, LinkId link) {
    return roads.links[static_cast<std::uint32_t>(link)].speed_limit_cmps / cm_per_m;
}

std::vector<GeoPoint> line_of(const RoadNetwork& roads, EdgeId edge) {
    const auto number = static_cast<std::uint32_t>(link_of(edge));
    const auto first = roads.links[number].first_point;
    const auto points = roads.points.subspan(first, last_point(roads, number) - first + 1);
    std::vector<GeoPoint> line(points.size());
    std::ranges::transform(points, line.begin(), Unpacked{});
    if (!is_forward(edge)) {
        std::ranges::reverse(line);
    }
    return line;
}

GeoPoint place_on(const RoadNetwork& roads, EdgeId edge, double offset_m) {
    const auto link = link_at(roads, edge);
    const auto way = way_at(roads, link.way);
    const double at_m = std::clamp(
        is_forward(edge) ? link.from_m + offset_m : link.to_m - offset_m, link.from_m, link.to_m);
    const auto next = std::ranges::upper_bound(
        way.along_m.begin() + link.first_point + 1, way.along_m.begin() + link.last_point, at_m);
    const auto i = static_cast<std::size_t>(next - way.along_m.begin());
    const double step_m = way.along_m[i] - way.along_m[i - 1];
    return between(
        way.line[i - 1], way.line[i], step_m > 0 ? (at_m - way.along_m[i - 1]) / step_m : 0.0);
}

std::vector<LinkId> links_near(const RoadNetwork& roads, const GeoBox& box) {
    if (is_empty(box)) {
        return {};
    }
    const auto numbers = numbers_meeting(roads.tree, on_grid(box));
    std::vector<LinkId> links(numbers.size());
    std::ranges::transform(numbers, links.begin(), [](auto number) { return LinkId{number}; });
    return links;
}

GeoBox extent_of(const RoadNetwork& roads) {
    if (roads.tree.boxes.empty()) {
        return {};
    }
    const auto& root = roads.tree.boxes.back();
    const auto southwest = Unpacked{}({root.south_e7, root.west_e7});
    const auto northeast = Unpacked{}({root.north_e7, root.east_e7});
    return {southwest.lon_deg, southwest.lat_deg, northeast.lon_deg, northeast.lat_deg};
}

} // namespace macadam
