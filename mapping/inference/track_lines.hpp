#pragma once

#include "mapping/geometry/local_frame.hpp"
#include "mapping/inference/network_inference.hpp"

#include <vector>

namespace macadam {

/// What a trip drew without a break, in a plane: points about spacing_m apart, the noise of single
/// positions taken out.
struct TraceLine {
    std::vector<PointEn> points;
    double sd_m;             ///< of its positions, across the road, as the receiver says
    bool after_turn = false; ///< begins where the line before it turned round
};

/// The lines of a trip. A line ends where the positions fall silent or jump, and where the car
/// turns round on its own road. Standing draws nothing, nor does what goes back after it.
std::vector<TraceLine>
trace_lines(const TripLog& trip, const LocalFrame& frame, const TraceConfig& config);

double apart_m(const PointEn& a, const PointEn& b);

/// Direction of the line at a point, radians clockwise from north. \param line  >= 2 points.
double course_rad(const std::vector<PointEn>& line, std::size_t i);

} // namespace macadam
