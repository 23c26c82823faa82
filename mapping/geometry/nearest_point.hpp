#pragma once

#include "estimator/common/geo.hpp"

#include <limits>
#include <span>

namespace macadam {

/// The point of a line nearest to a position.
struct LineFoot {
    double distance_m = std::numeric_limits<double>::infinity();
    double along_m = 0;    ///< from the start of the line
    double course_deg = 0; ///< of the line at that point; 0 for a single-point line
};

/// Finds the nearest point of a line. Accurate within a few kilometres. \param line  at least one
/// point.
LineFoot foot_on(std::span<const GeoPoint> line, const GeoPoint& place);

} // namespace macadam
