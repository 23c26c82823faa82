#include "mapping/geometry/nearest_point.hpp"

#include <algorithm>
#include <cassert>

namespace macadam {
namespace {

/// Assumes a straight line in degrees scaled to metres.
LineFoot foot_on(const GeoPoint& from, const GeoPoint& to, const GeoPoint& place) {
    const double whole_m = distance_m(from, to);
    const double to_start_m = distance_m(from, place);
    const double to_end_m = distance_m(to, place);
    // Law of cosines: position of the perpendicular's foot along the line segment.
    const double foot_m =
        whole_m > 0
            ? (to_start_m * to_start_m - to_end_m * to_end_m + whole_m * whole_m) / (2 * whole_m)
            : 0;
    const double along_m = std::clamp(foot_m, 0.0, whole_m);
    const auto foot = between(from, to, whole_m > 0 ? along_m / whole_m : 0);
    return {distance_m(place, foot), along_m, course_deg(from, to)};
}

} // namespace

LineFoot foot_on(std::span<const GeoPoint> line, const GeoPoint& place) {
    assert(!line.empty());
    LineFoot nearest{distance_m(line.front(), place), 0, 0};
    double passed_m = 0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const auto foot = foot_on(line[i], line[i + 1], place);
        if (foot.distance_m < nearest.distance_m || i == 0) {
            nearest = {foot.distance_m, passed_m + foot.along_m, foot.course_deg};
        }
        passed_m += distance_m(line[i], line[i + 1]);
    }
    return nearest;
}

} // namespace macadam
