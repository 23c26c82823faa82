#pragma once

#include "mapping/analysis/correlated_mean.hpp"
#include "mapping/analysis/worst_sections.hpp"
#include "mapping/routes/linear_route.hpp"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// A part of a ruler. from_m <= to_m.
struct RouteMeasureRange {
    double from_m;
    double to_m;
    friend bool operator==(const RouteMeasureRange&, const RouteMeasureRange&) = default;
};

/// States by segment; those without a pass are not there.
using SegmentStates = std::map<SegmentKey, SegmentState>;

/// A section of a road, as an agency reports it.
struct RoadSection {
    double from_m; ///< on the ruler of the road that it is cut from
    double to_m;
    double excluded_m;              ///< of its length
    double open_share;              ///< measured length by what is not excluded; 0 where all is
    CorrelatedMean measured;        ///< of what is not excluded
    std::vector<StretchPart> parts; ///< on its ways, in driving order; holes are left out
    std::vector<GeoPoint> line;
};

/// Sections of one length, and what is left at the end.
/// \param length_m  > 0
std::vector<RouteMeasureRange> even_sections(double whole_m, double length_m);

/// What is known of each section of a followed road.
///
/// \param sections  on the road's ruler, within it.
/// \param excluded  on the road's ruler, in order, not overlapping: what must not count.
std::vector<RoadSection> measured_sections(const RoadNetwork& roads,
                                           const LinearRoute& road,
                                           const SegmentStates& states,
                                           std::span<const RouteMeasureRange> sections,
                                           std::span<const RouteMeasureRange> excluded,
                                           const ErrorAlongRoad& errors = {});

} // namespace macadam
