#pragma once

#include "mapping/analysis/road_section.hpp"

#include <span>
#include <vector>

namespace macadam {

/// A place that must not count: a bridge, a crossing, works.
struct Exclusion {
    std::vector<GeoPoint> line; ///< one point or more
    double radius_m;            ///< around it
};

/// What of a followed road lies within the radius of an exclusion, to half a metre: ranges of its
/// ruler, in order, not overlapping.
std::vector<RouteMeasureRange> excluded_ranges(const RoadNetwork& roads,
                                               const LinearRoute& road,
                                               std::span<const Exclusion> exclusions);

} // namespace macadam
