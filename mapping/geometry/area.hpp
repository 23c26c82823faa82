#pragma once

#include "estimator/common/geo.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace macadam {

/// Polygon with holes: its rings, each closed from the last point to the first, in any direction.
using Polygon = std::vector<std::vector<GeoPoint>>;

/// Area on the map, the union of polygons whose sides are straight in degrees. An area across the
/// antimeridian is cut there into polygons, as RFC 7946, 3.1.9 has it.
class Area {
public:
    /// \param polygons  rings of fewer than 3 points are left out; a point is inside a polygon if
    ///                  a ray from it crosses an odd number of the polygon's sides
    explicit Area(const std::vector<Polygon>& polygons);

    /// Box around the area; empty if the area is.
    const GeoBox& box() const { return box_; }

    bool contains(const GeoPoint& point) const;

    /// Tests whether any point of a line is in the area.
    /// \param line  at least one point; may cross the antimeridian
    bool intersects(std::span<const GeoPoint> line) const;

private:
    struct Side {
        GeoPoint a, b;
        std::size_t polygon;
    };

    std::size_t band_of(double lat_deg) const;
    bool intersects_unbroken(std::span<const GeoPoint> line) const;

    GeoBox box_;
    std::vector<std::vector<Side>> bands_; ///< sides that touch each of equal bands of latitude
};

} // namespace macadam
