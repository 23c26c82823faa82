#pragma once

#include "mapping/geometry/surroundings.hpp"

#include <cstddef>

namespace macadam {

/// Part of a map to read, and what the reader found in the whole map.
struct NetworkCut {
    const Surroundings& around;
    std::size_t ways = 0;         ///< drivable ways
    GeoBox extent{};              ///< of all points
    bool holds_exchanged = false; ///< a point would lie in the surroundings if its latitude were
                                  ///< its longitude

    /// Takes note of a point of the map. \returns whether it lies in the surroundings.
    bool see(const GeoPoint& point) {
        extent = including(extent, point);
        holds_exchanged = holds_exchanged ||
                          around.contains({.lat_deg = point.lon_deg, .lon_deg = point.lat_deg});
        return around.contains(point);
    }
};

} // namespace macadam
