#pragma once

#include "estimator/common/geo.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace macadam {

enum class Oneway : std::uint8_t { no, forward, backward };

/// A road as a map has it: a line with the identity of its points.
struct Way {
    std::int64_t id;
    std::string name;
    std::string highway; ///< OSM's class, "" where there is none
    Oneway oneway = Oneway::no;
    std::vector<std::int64_t> node_ids; ///< two ways meet where they share one
    std::vector<GeoPoint> line;         ///< as many as node_ids, >= 2
};

/// Distinct integer types, so that one cannot be handed over for the other.
enum class NodeId : std::uint32_t {}; ///< of a junction or an end, in RoadNetwork::nodes
enum class LinkId : std::uint32_t {}; ///< of a way's part between two nodes, in RoadNetwork::links
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
    std::uint32_t way; ///< in RoadNetwork::ways
    NodeId from;       ///< in the way's own direction, whatever the traffic's
    NodeId to;
    std::uint32_t first_point; ///< of the way's line
    std::uint32_t last_point;  ///< >= first_point + 1; shared with the next link of the way
    double from_m;             ///< along the way, from its first node
    double to_m;
    bool forward; ///< may be driven so
    bool backward;
    std::uint32_t first_segment; ///< its INDEX: along the way, from its first node
    std::uint32_t segments;      ///< round(length / segment length), at least 1
};

/// Roads with topology: what a map says, cut at junctions, with the ways out of each node and an
/// index in space. Made once by build_network and then only read.
struct RoadNetwork {
    std::vector<Way> ways;                        ///< in the order of their ids
    std::vector<GeoPoint> nodes;                  ///< by NodeId
    std::vector<Link> links;                      ///< by LinkId, way by way
    std::vector<std::vector<double>> way_point_m; ///< per way: each point's distance from its first
    std::vector<std::uint32_t> out_first;         ///< per node + 1: into out_edges
    std::vector<EdgeId> out_edges;                ///< drivable edges that leave the node
    double segment_length_m = 20;

    /// A grid over the globe's plane of degrees: every link stands in each cell that its line
    /// touches. Sorted by cell.
    struct CellEntry {
        std::uint64_t cell;
        LinkId link;
    };
    std::vector<CellEntry> cells;
};

/// Links, topology, segments and index of the ways. A node is an end of a way, or a point that two
/// ways (or one way twice) share. Ways with fewer than two different points are left out.
///
/// \throws InputError  if two ways have one id, or a way comes within 0.1 degrees of the
/// antimeridian.
RoadNetwork build_network(std::vector<Way> ways, double segment_length_m = 20);

std::span<const EdgeId> out_edges(const RoadNetwork& roads, NodeId node);
bool is_drivable(const RoadNetwork& roads, EdgeId edge);
NodeId from_node(const RoadNetwork& roads, EdgeId edge);
NodeId to_node(const RoadNetwork& roads, EdgeId edge);
double length_m(const RoadNetwork& roads, LinkId link);
double length_m(const RoadNetwork& roads, EdgeId edge);

/// Places along the edge, in its direction of travel.
std::vector<GeoPoint> line_of(const RoadNetwork& roads, EdgeId edge);

/// The place `offset_m` along the edge, in its direction of travel; held at the ends.
GeoPoint place_on(const RoadNetwork& roads, EdgeId edge, double offset_m);

/// Links whose lines may meet the box, each once, in the order of their ids. A box larger than a
/// few thousand cells costs as much as going through all links.
std::vector<LinkId> links_near(const RoadNetwork& roads, const GeoBox& box);

GeoBox extent_of(const RoadNetwork& roads);

} // namespace macadam
