#pragma once

#include "estimator/common/geo.hpp"

#include <limits>
#include <span>

namespace macadam {

/// The point of a line that is nearest to a place.
struct LineFoot {
    double distance_m = std::numeric_limits<double>::infinity();
    double along_m = 0;    ///< from the line's beginning
    double course_deg = 0; ///< of the line there; 0 for a line of one point
};

/// Exact enough within some kilometres. \param line  at least one point.
LineFoot foot_on(std::span<const GeoPoint> line, const GeoPoint& place);

} // namespace macadam
