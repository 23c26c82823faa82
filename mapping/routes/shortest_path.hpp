#pragma once

#include "mapping/routes/linear_route.hpp"

namespace macadam {

struct RouteConfig {
    enum class Best { quickest, shortest };
    Best best = Best::quickest;
    double search_radius_m = 500; ///< of a place from its road
};

/// The way by car from the road that is nearest to one place to that of another, by speed limits
/// (speed_limit_mps) or by length. It begins and ends at the points of the roads nearest to the
/// places and may leave in either direction. It obeys oneways and turn restrictions, and turns
/// round only where there is no other way on. Of equal ways the one whose edges have the lower
/// numbers is taken.
///
/// \throws InputError  if no road is near a place, or no way joins them.
///
/// A* with the straight distance at the highest speed there is; P. E. Hart, N. J. Nilsson,
/// B. Raphael, IEEE Transactions on Systems Science and Cybernetics 4 (1968), pp. 100-107.
LinearRoute route_between(const RoadNetwork& roads,
                          const GeoPoint& from,
                          const GeoPoint& to,
                          const RouteConfig& config = {});

} // namespace macadam
