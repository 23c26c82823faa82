#pragma once

#include "estimator/common/geo.hpp"
#include "render/projection/crs_projection.hpp"

#include <vector>

namespace macadam {

/// Position on the picture: x to the right, y downwards, (0, 0) the top left corner of the top left
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

/// Mapping from the globe to the picture: spherical Mercator, north up; or a plane of PROJ, whose y
/// axis points up. In the latter case a radian represents 6,378,137 units of the plane, as it does
/// for metres of EPSG:3857.
///
/// Source: J. P. Snyder, "Map Projections: A Working Manual", USGS Professional Paper 1395 (1987),
/// eqs. 7-1 and 7-2, p. 41.
struct MapFrame {
    double px_per_rad; ///< along the equator
    double centre_x_rad, centre_y_rad;
    PixelPoint centre;
    const PlaneProjection* projection = nullptr; ///< null: spherical Mercator
};

/// Size of a box on the plane, radians.
struct PlaneExtent {
    double width_rad, height_rad;
};

/// Returns the largest frame that shows all of `box` inside `room`. A box of zero size is extended
/// to its surroundings.
///
/// A box whose east lies beyond 180 degrees continues over the antimeridian; the lines in it have
/// longitudes that continue likewise.
///
/// \param projection  null: spherical Mercator. Otherwise it must outlive the frame.
/// \throws InputError  if the box is empty, not on the globe, reaches beyond 85 degrees of latitude
///                     in Mercator, or lies outside the domain of the projection.
MapFrame
fitted_frame(const GeoBox& box, const PixelBox& room, const PlaneProjection* projection = nullptr);

/// Returns the size of a box on the plane, independent of a picture.
PlaneExtent plane_extent(const GeoBox& box, const PlaneProjection* projection);

/// Projects a point; NaN outside the domain of the projection.
PixelPoint to_pixel(const MapFrame& frame, const GeoPoint& point);
GeoPoint to_geo(const MapFrame& frame, const PixelPoint& pixel);

/// Returns the ground distance per pixel at a row of the picture, from left to right.
double metres_per_px(const MapFrame& frame, double y_px);

/// Returns the direction of north at a position on the picture, radians clockwise from up (the
/// convergence). 0 in Mercator.
double north_rad(const MapFrame& frame, const PixelPoint& at);

/// Returns the position of the frame's picture on its plane.
PlanePosition plane_position(const MapFrame& frame);

/// Densifies a line so that its straight pieces follow the projected curve of straight pieces in
/// degrees to a quarter of a pixel. In Mercator the line is unchanged, since pictures draw its
/// pieces straight.
std::vector<GeoPoint> bent(const MapFrame& frame, const std::vector<GeoPoint>& line);

} // namespace macadam
