#pragma once

#include "estimator/common/geo.hpp"
#include "mapping/network/network_records.hpp"
#include "mapping/network/packed_rtree.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

enum class Oneway : std::uint8_t { no, forward, backward };

/// A turn restriction from a way, as a map forbids or prescribes it.
struct TurnRule {
    std::int64_t via_node; ///< common end of both ways
    std::int64_t to_way;
    std::int64_t only = 0; ///< 0: this turn is forbidden; 1: every other turn is
    friend bool operator==(const TurnRule&, const TurnRule&) = default;
};

/// A road as in the map: a line with the ids of its points.
struct Way {
    std::int64_t id;
    std::string name;
    std::string highway; ///< OSM's class, "" if there is none
    Oneway oneway = Oneway::no;
    std::vector<std::int64_t> node_ids; ///< two ways meet where they share a node
    std::vector<GeoPoint> line;         ///< as many as node_ids, >= 2
    std::uint16_t speed_limit_cmps = 0; ///< as signposted, cm/s; 0: unknown
    std::vector<TurnRule> turns{};      ///< from this way
};

/// Distinct integer types that cannot be confused.
enum class NodeId : std::uint32_t {}; ///< a junction or an end, below node_count
enum class LinkId : std::uint32_t {}; ///< part of a way between two nodes, below link_count
enum class EdgeId : std::uint32_t {}; ///< a link and a direction of travel: 2 * link + backward

constexpr LinkId link_of(EdgeId edge) {
    return LinkId{static_cast<std::uint32_t>(edge) / 2};
}
constexpr bool is_forward(EdgeId edge) {
    return static_cast<std::uint32_t>(edge) % 2 == 0;
}
constexpr EdgeId edge_of(LinkId link, bool forward) {
    return EdgeId{2 * static_cast<std::uint32_t>(link) + (forward ? 0U : 1U)};
}
constexpr EdgeId reversed(EdgeId edge) {
    return EdgeId{static_cast<std::uint32_t>(edge) ^ 1U};
}

/// Part of a way between junctions.
struct Link {
    std::uint32_t way; ///< way number, for way_at
    NodeId from;       ///< in the way's own direction, whatever the traffic's
    NodeId to;
    std::uint32_t first_point; ///< index into the way's line
    std::uint32_t last_point;  ///< >= first_point + 1; shared with the next link of the way
    double from_m;             ///< along the way, from its first node; whole millimetres
    double to_m;
    bool forward; ///< drivable in this direction
    bool backward;
    std::uint32_t first_segment; ///< its first segment index along the way
    std::uint32_t segments;      ///< round(length / segment length), at least 1
};

/// A way in a network; must not outlive it.
struct WayView {
    std::int64_t id = 0;
    std::string_view name;
    std::string_view highway;
    Oneway oneway = Oneway::no;
    std::uint16_t speed_limit_cmps = 0;
    std::span<const std::int64_t> node_ids;
    PointRange line;     ///< as many as node_ids
    LengthRange along_m; ///< distance of each point from the first
    std::span<const TurnRule> turns;
    std::uint32_t first_link = 0; ///< its links are numbered consecutively
    std::uint32_t past_link = 0;
};

/// Roads with topology: the map's ways cut at junctions, with the edges leaving each node and a
/// spatial index. Created by build_network or from a file and then immutable; accessed through the
/// functions below. Copies are cheap and share their data.
///
/// Positions are stored on a grid of 1e-7 degrees (1 cm) and lengths in whole millimetres, so a
/// network is identical to the last bit whether built from a map, from a database or read from its
/// file.
struct RoadNetwork {
    std::shared_ptr<const void> owner; ///< of the memory behind the spans below
    double segment_length_m = 20;

    std::span<const PackedWay> ways;        ///< in id order, plus an end sentinel
    std::span<const PackedPoint> points;    ///< of the ways' lines, way by way
    std::span<const std::int64_t> node_ids; ///< one per point
    std::span<const std::uint32_t> along_mm;
    std::span<const PackedLink> links;         ///< way by way, plus an end sentinel
    std::span<const std::uint32_t> node_point; ///< per node: a point at the node
    std::span<const std::uint32_t>
        first_out;                     ///< per node, plus an end sentinel: index into out_edges
    std::span<const EdgeId> out_edges; ///< grouped by node
    std::span<const PackedTurn> turn_restrictions;
    std::span<const TurnRule> turns;             ///< grouped by way
    PackedRtree tree;                            ///< over parts of links
    std::span<const std::uint32_t> first_letter; ///< per text, plus an end sentinel
    std::span<const char> letters;
};

/// Returns the number of segments of a link; their length is as close as possible to the requested
/// one.
std::uint32_t segments_in(double link_m, double segment_length_m);

inline std::uint32_t way_count(const RoadNetwork& roads) { ///< ways are in id order
    return roads.ways.empty() ? 0 : static_cast<std::uint32_t>(roads.ways.size() - 1);
}
inline std::uint32_t node_count(const RoadNetwork& roads) {
    return static_cast<std::uint32_t>(roads.node_point.size());
}
inline std::uint32_t
link_count(const RoadNetwork& roads) { ///< links are grouped by way, in order along each
    return roads.links.empty() ? 0 : static_cast<std::uint32_t>(roads.links.size() - 1);
}

WayView way_at(const RoadNetwork& roads, std::uint32_t way);
WayView way_of(const RoadNetwork& roads, LinkId link);
WayView way_of(const RoadNetwork& roads, EdgeId edge);
Link link_at(const RoadNetwork& roads, LinkId link);
Link link_at(const RoadNetwork& roads, EdgeId edge);

/// Copies a way with its strings and positions.
Way copy_of(const WayView& way);
std::vector<Way> copies_of_ways(const RoadNetwork& roads);

/// Returns the drivable edges that leave the node.
inline std::span<const EdgeId> out_edges(const RoadNetwork& roads, NodeId node) {
    const auto index = static_cast<std::uint32_t>(node);
    const auto first = roads.first_out[index];
    return roads.out_edges.subspan(first, roads.first_out[index + 1] - first);
}

/// Returns all drivable edges, grouped by the node they leave.
inline std::span<const EdgeId> drivable_edges(const RoadNetwork& roads) {
    return roads.out_edges;
}

GeoPoint place_of(const RoadNetwork& roads, NodeId node);

inline const PackedLink& packed_link(const RoadNetwork& roads, EdgeId edge) {
    return roads.links[static_cast<std::uint32_t>(link_of(edge))];
}
inline bool is_drivable(const RoadNetwork& roads, EdgeId edge) {
    const auto flag = is_forward(edge) ? link_flags::forward : link_flags::backward;
    return (packed_link(roads, edge).flags & flag) != 0;
}
inline NodeId from_node(const RoadNetwork& roads, EdgeId edge) {
    const auto& link = packed_link(roads, edge);
    return NodeId{is_forward(edge) ? link.from : link.to};
}
inline NodeId to_node(const RoadNetwork& roads, EdgeId edge) {
    return from_node(roads, reversed(edge));
}
inline double length_m(const RoadNetwork& roads, EdgeId edge) {
    return Unpacked{}(packed_link(roads, edge).length_mm);
}
inline double length_m(const RoadNetwork& roads, LinkId link) {
    return length_m(roads, edge_of(link, true));
}

/// Returns true if no turn restriction of the map forbids the turn from an edge to one that leaves
/// its end. Does not check whether the edges are drivable.
bool may_turn(const RoadNetwork& roads, EdgeId from, EdgeId to);

/// Returns the speed limit: as signposted, or usual on roads of the class if the map states none.
/// Always finite: 250 km/h stands for "no limit".
double speed_limit_mps(const RoadNetwork& roads, LinkId link);

/// Returns the positions along the edge, in its direction of travel.
std::vector<GeoPoint> line_of(const RoadNetwork& roads, EdgeId edge);

/// Returns the position `offset_m` along the edge in its direction of travel, clamped to its ends.
GeoPoint place_on(const RoadNetwork& roads, EdgeId edge, double offset_m);

/// Finds the links whose lines may intersect the box, each once, in id order.
std::vector<LinkId> links_near(const RoadNetwork& roads, const GeoBox& box);

GeoBox extent_of(const RoadNetwork& roads);

} // namespace macadam
