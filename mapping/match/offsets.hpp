#pragma once

#include "mapping/match/path.hpp"

#include <vector>

namespace macadam {

/// Where on the path the trip was at a travel.
struct Knot {
    double travel_m; ///< rising
    double along_m;  ///< never falling; beyond the path's ends where the trip went beyond
};

/// Place along the path over travel: each position projected near where its sample was put, all of
/// them smoothed against travel. The difference of the two rulers drifts slowly (scale of the
/// odometer, cut corners of the map) while the error of positions is alike over hundreds of metres;
/// a random walk against that noise, smoothed forward and backward, weighs one against the other.
///
/// Source: H. E. Rauch, F. Tung, C. T. Striebel, "Maximum likelihood estimates of linear dynamic
/// systems", AIAA Journal 3 (1965), pp. 1445-1450.
std::vector<Knot> smoothed_knots(const RoadPath& path,
                                 const RoadNetwork& roads,
                                 RoadPlane& plane,
                                 const Positions& positions);

} // namespace macadam
