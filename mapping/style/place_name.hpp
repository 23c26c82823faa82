#pragma once

#include "estimator/common/geo.hpp"

#include <string>

namespace macadam {

/// Name of a place for a map.
struct PlaceName {
    std::string name;
    int rank = 0; ///< 0 city, 1 town, 2 village or suburb, 3 quarter, 4 hamlet or neighbourhood
    GeoPoint position;
};

} // namespace macadam
