#pragma once

#include "estimator/common/geo.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace macadam {

/// A place on the plane of a map projection, in its own units: x to the right, y upwards.
struct PlanePoint {
    double x = 0, y = 0;
};

/// Where a picture lies on its plane, in the plane's units (metres of EPSG:3857 in Mercator).
struct PlanePlace {
    double left, top; ///< of the top left corner of the top left pixel
    double per_px;    ///< side of a pixel
};

/// How the globe lies on a plane, by PROJ. Longitudes come first on every plane, whatever the
/// order of axes that its authority states.
struct PlaneProjection {
    std::string crs; ///< as it was asked for
    std::string wkt; ///< the same as WKT, for the files of other programs

    /// Nothing where the plane does not reach.
    std::function<std::optional<PlanePoint>(const GeoPoint&)> to_plane;
    std::function<std::optional<GeoPoint>(const PlanePoint&)> to_geo;
};

/// The projection of a coordinate reference system of two axes, projected or geographic.
///
/// \param crs  what PROJ reads: "EPSG:3006", a name, a PROJ string, WKT.
/// \throws InputError  if PROJ does not know it, or it is no such system.
///
/// Transformations that need grids use those that are installed and never ask the network.
std::shared_ptr<const PlaneProjection> plane_projection(const std::string& crs);

/// What the plug-in macadam_proj is asked for.
using ProjOpen = void(const std::string& crs, PlaneProjection& projection);
inline constexpr const char* proj_open_name = "macadam_proj_open";

} // namespace macadam
