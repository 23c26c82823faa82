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

/// A turn out of a way, as a map forbids or prescribes it.
struct TurnRule {
    std::int64_t via_node; ///< where both ways end
    std::int64_t to_way;
    std::int64_t only = 0; ///< 0: this turn is forbidden; 1: every other turn is
    friend bool operator==(const TurnRule&, const TurnRule&) = default;
};

/// A road as a map has it: a line with the identity of its points.
struct Way {
    std::int64_t id;
    std::string name;
    std::string highway; ///< OSM's class, "" where there is none
    Oneway oneway = Oneway::no;
    std::vector<std::int64_t> node_ids; ///< two ways meet where they share one
    std::vector<GeoPoint> line;         ///< as many as node_ids, >= 2
    std::uint16_t speed_limit_cmps = 0; ///< as signposted, cm/s; 0: not known
    std::vector<TurnRule> turns{};      ///< out of this way
};

/// Distinct integer types, so that one cannot be handed over for the other.
enum class NodeId : std::uint32_t {}; ///< of a junction or an end, below node_count
enum class LinkId : std::uint32_t {}; ///< of a way's part between two nodes, below link_count
enum class EdgeId : std::uint32_t {}; ///< of a link and a direction of travel: 2 * link + backward

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

/// A way's part between junctions.
struct Link {
    std::uint32_t way; ///< its number, for way_at
    NodeId from;       ///< in the way's own direction, whatever the traffic's
    NodeId to;
    std::uint32_t first_point; ///< of the way's line
    std::uint32_t last_point;  ///< >= first_point + 1; shared with the next link of the way
    double from_m;             ///< along the way, from its first node; whole millimetres
    double to_m;
    bool forward; ///< may be driven so
    bool backward;
    std::uint32_t first_segment; ///< its INDEX: along the way, from its first node
    std::uint32_t segments;      ///< round(length / segment length), at least 1
};

/// A way as a network holds it; lives no longer than the network.
struct WayView {
    std::int64_t id = 0;
    std::string_view name;
    std::string_view highway;
    Oneway oneway = Oneway::no;
    std::uint16_t speed_limit_cmps = 0;
    std::span<const std::int64_t> node_ids;
    PlaceRange line;     ///< as many as node_ids
    LengthRange along_m; ///< each point's distance from the first
    std::span<const TurnRule> turns;
    std::uint32_t first_link = 0; ///< its links are numbered in a row
    std::uint32_t past_link = 0;
};

/// Roads with topology: what a map says, cut at junctions, with the ways out of each node and an
/// index in space. Made once, by build_network or from a file, and then only read, by the functions
/// below; copies are cheap and share what they hold.
///
/// Places are held on the grid of 1e-7 degrees (1 cm), lengths in whole millimetres: so a network
/// is the same to the last bit whether it was built from a map, from a store or read from its file.
struct RoadNetwork {
    std::shared_ptr<const void> owner; ///< of the memory that the spans below look into
    double segment_length_m = 20;

    std::span<const PackedWay> ways;        ///< in the order of their ids, and one past the last
    std::span<const PackedPoint> points;    ///< of the ways' lines, way by way
    std::span<const std::int64_t> node_ids; ///< of the points
    std::span<const std::uint32_t> along_mm;
    std::span<const PackedLink> links;         ///< way by way, and one past the last
    std::span<const std::uint32_t> node_point; ///< per node: one of the points that lie there
    std::span<const std::uint32_t> first_out;  ///< per node and one past the last: into out_edges
    std::span<const EdgeId> out_edges;         ///< node by node
    std::span<const PackedTurn> turn_restrictions;
    std::span<const TurnRule> turns;             ///< way by way
    PackedRtree tree;                            ///< over pieces of links
    std::span<const std::uint32_t> first_letter; ///< per text and one past the last
    std::span<const char> letters;
};

/// Segments of a link: their length is as near as can be to the one that is asked for.
std::uint32_t segments_in(double link_m, double segment_length_m);

inline std::uint32_t way_count(const RoadNetwork& roads) { ///< in the order of their ids
    return roads.ways.empty() ? 0 : static_cast<std::uint32_t>(roads.ways.size() - 1);
}
inline std::uint32_t node_count(const RoadNetwork& roads) {
    return static_cast<std::uint32_t>(roads.node_point.size());
}
inline std::uint32_t link_count(const RoadNetwork& roads) { ///< way by way, along each
    return roads.links.empty() ? 0 : static_cast<std::uint32_t>(roads.links.size() - 1);
}

WayView way_at(const RoadNetwork& roads, std::uint32_t way);
WayView way_of(const RoadNetwork& roads, LinkId link);
WayView way_of(const RoadNetwork& roads, EdgeId edge);
Link link_at(const RoadNetwork& roads, LinkId link);
Link link_at(const RoadNetwork& roads, EdgeId edge);

/// With strings and places of its own.
Way copy_of(const WayView& way);
std::vector<Way> copies_of_ways(const RoadNetwork& roads);

/// Drivable edges that leave the node.
inline std::span<const EdgeId> out_edges(const RoadNetwork& roads, NodeId node) {
    const auto index = static_cast<std::uint32_t>(node);
    const auto first = roads.first_out[index];
    return roads.out_edges.subspan(first, roads.first_out[index + 1] - first);
}

/// All edges that may be driven, node by node of their departure.
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

/// Whether traffic may go on from an edge to one that leaves its end: no turn restriction of the
/// map forbids it. Says nothing of whether the edges are drivable.
bool may_turn(const RoadNetwork& roads, EdgeId from, EdgeId to);

/// What a car may drive there: the signposted limit, or what is usual on roads of the class where
/// the map states none. Infinite nowhere: 250 km/h stands for "no limit".
double speed_limit_mps(const RoadNetwork& roads, LinkId link);

/// Places along the edge, in its direction of travel.
std::vector<GeoPoint> line_of(const RoadNetwork& roads, EdgeId edge);

/// The place `offset_m` along the edge, in its direction of travel; held at the ends.
GeoPoint place_on(const RoadNetwork& roads, EdgeId edge, double offset_m);

/// Links whose lines may meet the box, each once, in the order of their ids.
std::vector<LinkId> links_near(const RoadNetwork& roads, const GeoBox& box);

GeoBox extent_of(const RoadNetwork& roads);

} // namespace macadam
