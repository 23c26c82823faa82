#pragma once

#include "estimator/common/geo.hpp"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// Coordinate reference systems of features, by the order and unit of their axes.
enum class CoordinateReference {
    crs84,     ///< longitude, latitude; the default
    epsg_4326, ///< latitude, longitude
    epsg_3857, ///< Web Mercator: metres east, north
};

/// Their URIs, in the order of the enumeration.
inline constexpr std::array<std::string_view, 3> coordinate_reference_uris{
    "http://www.opengis.net/def/crs/OGC/1.3/CRS84",
    "http://www.opengis.net/def/crs/EPSG/0/4326",
    "http://www.opengis.net/def/crs/EPSG/0/3857"};

std::string_view uri_of(CoordinateReference crs);
std::optional<CoordinateReference> parse_coordinate_reference(std::string_view uri);

/// Position from a pair of coordinates.
GeoPoint geo_point_of(CoordinateReference crs, double first, double second);

/// Rounds a position to the decimals with which features show it in degrees.
GeoPoint as_shown(const GeoPoint& point);

/// Appends a point, or a line, as the geometry of GeoJSON.
/// \param is_point  the line has one position, of a point
void append_geometry(std::string& text,
                     std::span<const GeoPoint> line,
                     bool is_point,
                     CoordinateReference crs);

} // namespace macadam
