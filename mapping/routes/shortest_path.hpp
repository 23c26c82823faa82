#pragma once

#include "mapping/routes/linear_route.hpp"

namespace macadam {

struct RouteConfig {
    enum class Best { quickest, shortest };
    Best best = Best::quickest;
    double search_radius_m = 500; ///< of a position from its road
};

/// Finds the best route by car between the roads nearest to two positions, by speed limits
/// (speed_limit_mps) or by length. It begins and ends at the points of the roads nearest to the
/// positions and may leave in either direction. It obeys oneways and turn restrictions, and turns
/// round only where there is no other way on. Ties are resolved by the lowest edge numbers.
///
/// \throws InputError  if no road is near a position, or no route joins them.
///
/// A* with the straight-line distance at the highest speed limit; P. E. Hart, N. J. Nilsson, B.
/// Raphael, IEEE Transactions on Systems Science and Cybernetics 4 (1968), pp. 100-107.
LinearRoute route_between(const RoadNetwork& roads,
                          const GeoPoint& from,
                          const GeoPoint& to,
                          const RouteConfig& config = {});

} // namespace macadam
