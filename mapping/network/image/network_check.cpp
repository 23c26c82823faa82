#include "mapping/network/image/network_check.hpp"

#include "estimator/common/error.hpp"
#include "mapping/network/network_arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

constexpr std::int32_t farthest_lat_e7 = 900'000'000;
constexpr std::int32_t farthest_lon_e7 = 1'799'000'000;
static_assert(farthest_lon_e7 == farthest_lon_deg * Unpacked::per_deg);

void expect(bool holds, std::string_view what) {
    if (!holds) {
        throw InputError{fmt::format("is not a valid network: {}", what)};
    }
}

/// Returns true if values begin at 0, never decrease and end at `last`.
bool are_offsets(std::span<const std::uint32_t> values, std::size_t last) {
    return !values.empty() && values.front() == 0 && values.back() == last &&
           std::ranges::is_sorted(values);
}

bool is_place(std::int32_t lat_e7, std::int32_t lon_e7) {
    return lat_e7 >= -farthest_lat_e7 && lat_e7 <= farthest_lat_e7 && lon_e7 >= -farthest_lon_e7 &&
           lon_e7 <= farthest_lon_e7;
}

void check_sizes(const RoadNetwork& roads) {
    const NetworkLimits limits;
    expect(std::isfinite(roads.segment_length_m) && roads.segment_length_m > 0,
           "its segment length is invalid");
    expect(!roads.ways.empty() && !roads.links.empty() && !roads.first_letter.empty() &&
               roads.points.size() == roads.node_ids.size() &&
               roads.points.size() == roads.along_mm.size() &&
               roads.first_out.size() == roads.node_point.size() + 1,
           "its arrays do not fit each other");
    expect(roads.points.size() < limits.points && roads.turns.size() < limits.turns &&
               roads.letters.size() < limits.letters &&
               roads.ways.size() <= roads.points.size() + 1 &&
               roads.links.size() <= roads.points.size() + 1 &&
               roads.node_point.size() <= roads.points.size(),
           "it has more records than it can number");
    expect(roads.tree.numbers.size() < limits.points &&
               roads.tree.boxes.size() == box_tree_size(roads.tree.numbers.size()),
           "its index has another size than its tree");
}

void check_texts(const RoadNetwork& roads) {
    expect(are_offsets(roads.first_letter, roads.letters.size()),
           "its texts do not follow one another");
}

/// \returns true if a way and the next, which may be the end sentinel, are consistent.
bool is_sound(const RoadNetwork& roads, const PackedWay& way, const PackedWay& next) {
    const auto texts = roads.first_letter.size() - 1;
    return next.first_point > way.first_point && next.first_point - way.first_point >= 2 &&
           next.first_link > way.first_link && next.first_turn >= way.first_turn &&
           way.name < texts && way.highway < texts &&
           way.oneway <= static_cast<std::uint8_t>(Oneway::backward) && way.zero == 0 &&
           roads.along_mm[way.first_point] == 0;
}

void check_ways(const RoadNetwork& roads) {
    const auto& first = roads.ways.front();
    const auto& past = roads.ways.back();
    expect(first.first_point == 0 && first.first_link == 0 && first.first_turn == 0 &&
               past.first_point == roads.points.size() &&
               past.first_link == roads.links.size() - 1 && past.first_turn == roads.turns.size(),
           "its ways do not begin or end with their points, links and turns");
    // Check all bounds before accessing the points of any way.
    expect(std::ranges::is_sorted(roads.ways, {}, &PackedWay::first_point),
           "its ways do not follow one another");
    for (std::size_t i = 0; i + 1 < roads.ways.size(); ++i) {
        const auto& way = roads.ways[i];
        expect(is_sound(roads, way, roads.ways[i + 1]), fmt::format("way '{}' is invalid", way.id));
        expect(i == 0 || roads.ways[i - 1].id < way.id, "its ways are not in order");
        const auto lengths = roads.along_mm.subspan(
            way.first_point, roads.ways[i + 1].first_point - way.first_point);
        expect(std::ranges::is_sorted(lengths),
               fmt::format("the lengths along way '{}' decrease", way.id));
    }
    expect(std::ranges::all_of(
               roads.points,
               [](const PackedPoint& point) { return is_place(point.lat_e7, point.lon_e7); }),
           "a point has no valid position");
    expect(std::ranges::all_of(
               roads.turns, [](const TurnRule& rule) { return rule.only == 0 || rule.only == 1; }),
           "a turn restriction is invalid");
}

/// Returns the number of the last point of a link of the way.
std::uint32_t last_point(const RoadNetwork& roads, std::uint32_t link, std::uint32_t way) {
    return link + 1 < roads.ways[way + 1].first_link ? roads.links[link + 1].first_point
                                                     : roads.ways[way + 1].first_point - 1;
}

/// Returns true if the node's point has the id of this point.
bool lies_at(const RoadNetwork& roads, std::uint32_t node, std::uint32_t point) {
    return node < roads.node_point.size() &&
           roads.node_ids[roads.node_point[node]] == roads.node_ids[point];
}

/// \param segments  number of segments of the way's links before this one
bool is_sound(const RoadNetwork& roads,
              const PackedLink& link,
              std::uint32_t way,
              std::uint32_t last,
              std::uint64_t segments) {
    constexpr auto barred = link_flags::forward_barred | link_flags::backward_barred;
    return link.way == way && last > link.first_point && last < roads.ways[way + 1].first_point &&
           lies_at(roads, link.from, link.first_point) && lies_at(roads, link.to, last) &&
           link.length_mm == roads.along_mm[last] - roads.along_mm[link.first_point] &&
           link.first_segment == segments && link.speed_limit_cmps > 0 &&
           (link.flags & ~barred) == flags_of(static_cast<Oneway>(roads.ways[way].oneway));
}

void check_links(const RoadNetwork& roads) {
    const auto most = max_segments(roads.points.size(), {});
    const auto past = static_cast<std::uint32_t>(roads.ways.size() - 1);
    std::uint64_t all_segments = 0;
    for (std::uint32_t way = 0; way < past; ++way) {
        std::uint64_t segments = 0;
        const auto first = roads.ways[way].first_link;
        expect(roads.links[first].first_point == roads.ways[way].first_point,
               "a way's links do not begin with it");
        for (auto i = first; i < roads.ways[way + 1].first_link; ++i) {
            const auto& link = roads.links[i];
            expect(is_sound(roads, link, way, last_point(roads, i, way), segments),
                   fmt::format("link {} is invalid", i));
            segments += segments_in(Unpacked{}(link.length_mm), roads.segment_length_m);
        }
        all_segments += segments;
        expect(all_segments <= most && segments <= std::numeric_limits<std::uint32_t>::max(),
               "it has more segments than its points make");
    }
    expect(roads.links.back().way == past && roads.links.back().first_point == roads.points.size(),
           "its links do not end with its ways");
}

void check_nodes(const RoadNetwork& roads) {
    expect(std::ranges::all_of(roads.node_point,
                               [&](std::uint32_t point) { return point < roads.points.size(); }),
           "a node is not a point");
    for (std::size_t i = 1; i < roads.node_point.size(); ++i) {
        expect(roads.node_ids[roads.node_point[i - 1]] < roads.node_ids[roads.node_point[i]],
               "its nodes are not in order");
    }
}

bool is_edge(const RoadNetwork& roads, std::uint32_t edge) {
    return edge / 2 < roads.links.size() - 1 && is_drivable(roads, EdgeId{edge});
}

/// Checks that each node lists the drivable edges that leave it, in order.
void check_departures(const RoadNetwork& roads) {
    expect(are_offsets(roads.first_out, roads.out_edges.size()),
           "its nodes' edges do not follow one another");
    for (std::uint32_t node = 0; node < roads.node_point.size(); ++node) {
        const auto edges = out_edges(roads, NodeId{node});
        for (std::size_t i = 0; i < edges.size(); ++i) {
            expect(is_edge(roads, static_cast<std::uint32_t>(edges[i])) &&
                       from_node(roads, edges[i]) == NodeId{node} &&
                       (i == 0 || edges[i - 1] < edges[i]),
                   fmt::format("an edge out of node {} is invalid", node));
        }
    }
    std::size_t drivable = 0;
    for (std::uint32_t edge = 0; edge < 2 * (roads.links.size() - 1); ++edge) {
        drivable += is_drivable(roads, EdgeId{edge}) ? 1 : 0;
    }
    expect(drivable == roads.out_edges.size(), "an edge starts at no node");
}

bool is_flagged(const RoadNetwork& roads, EdgeId edge) {
    const auto flag = is_forward(edge) ? link_flags::forward_barred : link_flags::backward_barred;
    return (packed_link(roads, edge).flags & flag) != 0;
}

/// Checks that forbidden turns are valid and sorted, and that the links' flags mark the edges with
/// any.
void check_turns(const RoadNetwork& roads) {
    std::size_t barred_edges = 0;
    for (std::size_t i = 0; i < roads.turn_restrictions.size(); ++i) {
        const auto& turn = roads.turn_restrictions[i];
        expect(is_edge(roads, turn.from) && is_edge(roads, turn.to) &&
                   to_node(roads, EdgeId{turn.from}) == from_node(roads, EdgeId{turn.to}) &&
                   is_flagged(roads, EdgeId{turn.from}) &&
                   (i == 0 || roads.turn_restrictions[i - 1] < turn),
               "a forbidden turn is invalid");
        barred_edges += i == 0 || roads.turn_restrictions[i - 1].from != turn.from ? 1 : 0;
    }
    std::size_t flagged = 0;
    for (std::uint32_t edge = 0; edge < 2 * (roads.links.size() - 1); ++edge) {
        flagged += is_flagged(roads, EdgeId{edge}) ? 1 : 0;
    }
    expect(flagged == barred_edges, "a link refers to missing forbidden turns");
}

bool holds(const GridBox& box, std::span<const GridBox> below) {
    auto around = below.front();
    for (const auto& other : below) {
        around = {std::min(around.south_e7, other.south_e7),
                  std::min(around.west_e7, other.west_e7),
                  std::max(around.north_e7, other.north_e7),
                  std::max(around.east_e7, other.east_e7)};
    }
    return box == around;
}

/// Returns true if every box above the leaves is the smallest around its children.
bool boxes_hold_each_other(const PackedRtree& tree) {
    std::size_t first = 0;
    auto past = tree.numbers.size();
    while (past - first > 1) {
        auto parent = past;
        for (; first < past; first += box_tree_fan_out) {
            const auto count = std::min(box_tree_fan_out, past - first);
            if (!holds(tree.boxes[parent++], tree.boxes.subspan(first, count))) {
                return false;
            }
        }
        first = past;
        past = parent;
    }
    return true;
}

/// Checks that each link has its boxes in the index, and that each inner box contains its children.
void check_index(const RoadNetwork& roads) {
    const auto& numbers = roads.tree.numbers;
    const auto links = static_cast<std::uint32_t>(roads.links.size() - 1);
    std::vector<bool> is_met(links, false);
    for (const auto number : numbers) {
        expect(number < links, "its index refers to a missing link");
        is_met[number] = true;
    }
    std::size_t pieces = 0;
    for (std::uint32_t way = 0; way + 1 < roads.ways.size(); ++way) {
        for (auto i = roads.ways[way].first_link; i < roads.ways[way + 1].first_link; ++i) {
            pieces += pieces_of(last_point(roads, i, way) - roads.links[i].first_point);
        }
    }
    expect(pieces == numbers.size() && std::ranges::find(is_met, false) == is_met.end(),
           "its index lacks links");
    expect(std::ranges::all_of(roads.tree.boxes.first(numbers.size()),
                               [](const GridBox& box) {
                                   return box.south_e7 <= box.north_e7 &&
                                          box.west_e7 <= box.east_e7 &&
                                          is_place(box.south_e7, box.west_e7) &&
                                          is_place(box.north_e7, box.east_e7);
                               }),
           "its index has an invalid box");
    expect(boxes_hold_each_other(roads.tree), "a box of its index does not contain its children");
}

} // namespace

void expect_sound(const RoadNetwork& roads) {
    check_sizes(roads);
    check_texts(roads);
    check_ways(roads);
    check_nodes(roads);
    check_links(roads);
    check_departures(roads);
    check_turns(roads);
    check_index(roads);
}

} // namespace macadam
