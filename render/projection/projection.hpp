#pragma once

#include "estimator/common/geo.hpp"
#include "render/projection/crs_projection.hpp"

#include <vector>

namespace macadam {

/// A place on the picture: x to the right, y downwards, (0, 0) the top left corner of the top left
/// pixel.
struct PixelPoint {
    double x = 0, y = 0;
    friend bool operator==(const PixelPoint&, const PixelPoint&) = default;
};

struct PixelBox {
    double left = 0, top = 0, right = 0, bottom = 0;
    friend bool operator==(const PixelBox&, const PixelBox&) = default;
    double width() const { return right - left; }
    double height() const { return bottom - top; }
};

/// How the globe lies on the picture: spherical Mercator, north up; or a plane of PROJ's, whose y
/// axis points up. Then a radian stands for 6,378,137 units of the plane, as it does for metres of
/// EPSG:3857.
///
/// Source: J. P. Snyder, "Map Projections: A Working Manual", USGS Professional Paper 1395 (1987),
/// eqs. 7-1 and 7-2, p. 41.
struct MapFrame {
    double px_per_rad; ///< along the equator
    double centre_x_rad, centre_y_rad;
    PixelPoint centre;
    const PlaneProjection* projection = nullptr; ///< null: spherical Mercator
};

/// What a picture of a box takes up on the plane, radians.
struct PlaneExtent {
    double width_rad, height_rad;
};

/// The largest frame that shows all of `box` inside `room`. A box of no size is taken for a
/// neighbourhood.
///
/// A box whose east lies beyond 180 degrees goes on over the antimeridian; the lines in it have
/// longitudes that go on likewise.
///
/// \param projection  null: spherical Mercator. Otherwise it must outlive the frame.
/// \throws InputError  if the box is empty, not on the globe, reaches beyond 85 degrees of latitude
///                     in Mercator, or lies where the projection does not reach.
MapFrame
fitted_frame(const GeoBox& box, const PixelBox& room, const PlaneProjection* projection = nullptr);

/// Of the same, before there is a picture.
PlaneExtent plane_extent(const GeoBox& box, const PlaneProjection* projection);

/// Not a number where the projection does not reach.
PixelPoint to_pixel(const MapFrame& frame, const GeoPoint& point);
GeoPoint to_geo(const MapFrame& frame, const PixelPoint& pixel);

/// On the ground, at a height of the picture, from left to right.
double metres_per_px(const MapFrame& frame, double y_px);

/// Where north is at a place of the picture, radians clockwise from up: the convergence. 0 in
/// Mercator.
double north_rad(const MapFrame& frame, const PixelPoint& at);

/// Where the picture of this frame lies on its plane.
PlanePlace plane_place(const MapFrame& frame);

/// The line with as many points more as it takes for its straight pieces to follow what the
/// projection makes of straight pieces in degrees, to a quarter of a pixel. The line itself in
/// Mercator, where pictures draw pieces straight.
std::vector<GeoPoint> bent(const MapFrame& frame, const std::vector<GeoPoint>& line);

} // namespace macadam
