#pragma once

#include "mapping/matching/map_match.hpp"
#include "mapping/network/road_network.hpp"
#include "mapping/network/segment.hpp"

#include <optional>
#include <vector>

namespace macadam {

/// An interval of an edge, or a gap.
struct RouteEdge {
    std::optional<EdgeId> edge;
    double from_m; ///< along the edge, in its direction of travel; 0 in a gap
    double to_m;   ///< >= from_m
};

/// A linear-referenced route in driving direction. Its measure begins at 0 and runs through all
/// parts, gaps included.
struct LinearRoute {
    std::vector<RouteEdge> parts;
};

double length_m(const LinearRoute& road);

/// Builds the route of the roads that a trace was matched to; intervals off the network are gaps.
LinearRoute followed(const MatchedTrace& trace);

/// Builds a route along a way.
///
/// \param from_m, to_m  along the way from its first node, clamped to its ends; `std::nullopt`: the
///                      entire way.
/// \param forward       direction of the route; `std::nullopt`: from `from_m` to `to_m`, so against
///                      the way's own direction if the measures decrease.
/// \throws InputError  if the network has no such way.
LinearRoute route_along_way(const RoadNetwork& roads,
                            std::int64_t way_id,
                            std::optional<double> from_m,
                            std::optional<double> to_m,
                            std::optional<bool> forward);

/// Builds the route of a named road: its ways, each joined at its end to the next that continues
/// without a sharp turn, in the direction in which most of it was drawn.
///
/// \throws InputError  if there is none, or if the ways of that name are not one road.
LinearRoute route_of_named_road(const RoadNetwork& roads, std::string_view name);

/// Extracts the route between two measures; reversed if from_m > to_m.
LinearRoute part_of(const LinearRoute& road, const RoadNetwork& roads, double from_m, double to_m);

/// Overlap of a route with one segment, or a gap.
struct RouteSegment {
    std::optional<SegmentKey> segment; ///< `std::nullopt`: a gap
    double from_m;                     ///< route measure
    double to_m;
    double segment_middle_m; ///< route measure of the midpoint of the entire segment
    double way_from_m;       ///< along the way from its first node, way_from_m < way_to_m
    double way_to_m;
};

/// Cuts a route into segments, contiguous in the order of measure.
std::vector<RouteSegment> pieces_of(const RoadNetwork& roads, const LinearRoute& road);

/// Collects the segments of these intervals, neighbours as one range.
std::vector<SegmentRange> ranges_of(const std::vector<RouteSegment>& pieces);

/// Returns the positions along an interval of the route, given by measure; gaps are skipped.
std::vector<GeoPoint>
line_of(const RoadNetwork& roads, const LinearRoute& road, double from_m, double to_m);

} // namespace macadam
