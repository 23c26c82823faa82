#pragma once

#include "mapping/routes/linear_route.hpp"

#include <span>
#include <vector>

namespace macadam {

/// The roads that a drawn line follows, in its direction, found as those of a trip are (map_match):
/// as if a car had driven it at a steady pace. Where the line leaves the roads, or the traffic may
/// not go its way, is a hole.
///
/// \param line  two places or more, not all one. \throws InputError  otherwise.
LinearRoute matched_line(const RoadNetwork& roads, std::span<const GeoPoint> line);

/// What of a drawn line lies on one segment.
struct LinePart {
    SegmentKey segment;
    double segment_m;      ///< the segment's length
    double from_station_m; ///< along the way (station_m), rising
    double to_station_m;
    double from_line_m; ///< along the drawn line, from_line_m < to_line_m
    double to_line_m;
    double confidence; ///< of the match, 0..1
};

/// The same match on the line's own ruler, cut at the borders of segments, in the order of the
/// line. \throws InputError  as matched_line.
std::vector<LinePart> line_parts(const RoadNetwork& roads, std::span<const GeoPoint> line);

} // namespace macadam
