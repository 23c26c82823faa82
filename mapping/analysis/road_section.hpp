#pragma once

#include "mapping/analysis/correlated_mean.hpp"
#include "mapping/analysis/worst_sections.hpp"
#include "mapping/routes/linear_route.hpp"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// An interval of route measures. from_m <= to_m.
struct RouteMeasureRange {
    double from_m;
    double to_m;
    friend bool operator==(const RouteMeasureRange&, const RouteMeasureRange&) = default;
};

/// States by segment; segments without a pass are absent.
using SegmentStates = std::map<SegmentKey, SegmentState>;

/// A section of a route, as agencies report it.
struct RoadSection {
    double from_m; ///< measure on its route
    double to_m;
    double excluded_m; ///< excluded length
    double open_share; ///< measured share of the length that is not excluded; 0 if all is excluded
    CorrelatedMean measured;        ///< over the length that is not excluded
    std::vector<StretchPart> parts; ///< on its ways, in driving order, without gaps
    std::vector<GeoPoint> line;
};

/// Cuts sections of equal length; the last one may be shorter.
///
/// \param length_m  > 0
std::vector<RouteMeasureRange> even_sections(double whole_m, double length_m);

/// Computes the roughness of each section of a route.
///
/// \param sections  route measures within the route.
/// \param excluded  route measures to leave out, in order, disjoint.
std::vector<RoadSection> measured_sections(const RoadNetwork& roads,
                                           const LinearRoute& road,
                                           const SegmentStates& states,
                                           std::span<const RouteMeasureRange> sections,
                                           std::span<const RouteMeasureRange> excluded,
                                           const ErrorAlongRoad& errors = {});

} // namespace macadam
