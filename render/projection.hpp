#pragma once

#include "estimator/common/geo.hpp"

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

/// How the globe lies on the picture: spherical Mercator, north up.
///
/// Source: J. P. Snyder, "Map Projections: A Working Manual", USGS Professional Paper 1395 (1987),
/// eqs. 7-1 and 7-2, p. 41.
struct MapFrame {
    double px_per_rad; ///< along the equator
    double centre_x_rad, centre_y_rad;
    PixelPoint centre;
};

/// The largest frame that shows all of `box` inside `room`. A box of no size is taken for a
/// neighbourhood.
///
/// \throws InputError  if the box is empty, not on the globe, or reaches beyond 85 degrees of
///                     latitude.
MapFrame fitted_frame(const GeoBox& box, const PixelBox& room);

PixelPoint to_pixel(const MapFrame& frame, const GeoPoint& point);
GeoPoint to_geo(const MapFrame& frame, const PixelPoint& pixel);

/// On the ground, at a height of the picture.
double metres_per_px(const MapFrame& frame, double y_px);

} // namespace macadam
