#pragma once

#include "mapping/routes/linear_route.hpp"

#include <span>
#include <vector>

namespace macadam {

/// Matches a drawn line to the roads it follows, in its direction, with map_match, as if a car had
/// driven it at a steady speed. The route has a gap where the line leaves the roads or goes against
/// the traffic.
///
/// \param line  two or more positions, not all equal. \throws InputError  otherwise.
LinearRoute matched_line(const RoadNetwork& roads, std::span<const GeoPoint> line);

/// Overlap of a drawn line with one segment.
struct LinePart {
    SegmentKey segment;
    double segment_m;      ///< length of the segment
    double from_station_m; ///< along the way (station_m), increasing
    double to_station_m;
    double from_line_m; ///< along the drawn line, from_line_m < to_line_m
    double to_line_m;
    double confidence; ///< of the match, 0..1
};

/// Matches a drawn line likewise, by measure along the line, cut at segment boundaries, in the
/// order of the line. \throws InputError  as matched_line.
std::vector<LinePart> line_parts(const RoadNetwork& roads, std::span<const GeoPoint> line);

} // namespace macadam
