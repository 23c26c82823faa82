#pragma once

#include "mapping/analysis/road_section.hpp"

#include <span>
#include <vector>

namespace macadam {

/// A site to exclude from statistics: a bridge, a crossing, road works.
struct Exclusion {
    std::vector<GeoPoint> line; ///< at least one point
    double radius_m;            ///< around the line
};

/// Returns the parts of a route within the radius of an exclusion, to half a metre: ranges of
/// measure, in order and disjoint.
std::vector<RouteMeasureRange> excluded_ranges(const RoadNetwork& roads,
                                               const LinearRoute& road,
                                               std::span<const Exclusion> exclusions);

} // namespace macadam
