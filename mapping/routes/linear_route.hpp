#pragma once

#include "mapping/matching/map_match.hpp"
#include "mapping/network/road_network.hpp"
#include "mapping/network/segment.hpp"

#include <optional>
#include <vector>

namespace macadam {

/// A part of an edge, or of no road: a hole.
struct RouteEdge {
    std::optional<EdgeId> edge;
    double from_m; ///< along the edge, in its direction of travel; 0 in a hole
    double to_m;   ///< >= from_m
};

/// A road that is followed from place to place, in driving direction. Its ruler begins at 0 and
/// runs through the parts, holes included.
struct LinearRoute {
    std::vector<RouteEdge> parts;
};

double length_m(const LinearRoute& road);

/// The roads that a trace was matched to; what it did off the network is a hole.
LinearRoute followed(const MatchedTrace& trace);

/// A part of a way. \param from_m, to_m  along the way from its first node, whole way if nothing;
/// held at its ends. \param forward  in which direction it is followed; nothing: from `from_m` to
/// `to_m`, so against the way's own direction where stations fall.
/// \throws InputError  if the network has no such way.
LinearRoute route_along_way(const RoadNetwork& roads,
                            std::int64_t way_id,
                            std::optional<double> from_m,
                            std::optional<double> to_m,
                            std::optional<bool> forward);

/// All of a road by its name: its ways, each from its end into the next that goes on without a
/// sharp turn, in the direction in which most of it was drawn.
/// \throws InputError  if there is none, or if what has the name is not one road.
LinearRoute route_of_named_road(const RoadNetwork& roads, std::string_view name);

/// The part of a road between two places of its ruler; the other way round where from_m > to_m.
LinearRoute part_of(const LinearRoute& road, const RoadNetwork& roads, double from_m, double to_m);

/// What of a followed road lies in one segment, or in a hole.
struct RouteSegment {
    std::optional<SegmentKey> segment; ///< nothing: a hole
    double from_m;                     ///< on the road's ruler
    double to_m;
    double segment_middle_m; ///< on the ruler, of the whole segment, however much is followed
    double way_from_m;       ///< along the way from its first node, way_from_m < way_to_m
    double way_to_m;
};

/// In the order of the ruler, one after the other.
std::vector<RouteSegment> pieces_of(const RoadNetwork& roads, const LinearRoute& road);

/// The segments of these pieces, neighbours as one range.
std::vector<SegmentRange> ranges_of(const std::vector<RouteSegment>& pieces);

/// Places along a part of the road, on its ruler; holes are jumped.
std::vector<GeoPoint>
line_of(const RoadNetwork& roads, const LinearRoute& road, double from_m, double to_m);

} // namespace macadam
