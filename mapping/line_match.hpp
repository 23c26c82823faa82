#pragma once

#include "mapping/followed_road.hpp"

#include <span>

namespace macadam {

/// The roads that a drawn line follows, in its direction, found as those of a trip are (map_match):
/// as if a car had driven it at a steady pace. Where the line leaves the roads, or the traffic may
/// not go its way, is a hole.
///
/// \param line  two places or more, not all one. \throws InputError  otherwise.
FollowedRoad matched_line(const RoadNetwork& roads, std::span<const GeoPoint> line);

} // namespace macadam
