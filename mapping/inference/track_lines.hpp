#pragma once

#include "mapping/geometry/local_frame.hpp"
#include "mapping/inference/network_inference.hpp"

#include <vector>

namespace macadam {

/// A continuous line of a trip in a plane: points about spacing_m apart, with the noise of single
/// positions removed.
struct TraceLine {
    std::vector<PointEn> points;
    double sd_m;             ///< of its positions, across the road, as stated by the receiver
    bool after_turn = false; ///< begins where the line before it turned round
};

/// Extracts the lines of a trip. A line ends at a gap or jump of the positions, and where the car
/// turns round on its own road. Standing draws no line, nor does moving back after it.
std::vector<TripDrawing::Line> trace_lines(const TripLog& trip, const TraceConfig& config);

/// Returns a frame around the middle of a box; around 0, 0 if it is empty.
LocalFrame frame_in_middle_of(const GeoBox& box);

double apart_m(const PointEn& a, const PointEn& b);

/// Returns the direction of the line at a point, radians clockwise from north. \param line  >= 2
/// points.
double course_rad(const std::vector<PointEn>& line, std::size_t i);

} // namespace macadam
