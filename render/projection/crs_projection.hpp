#pragma once

#include "estimator/common/geo.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace macadam {

/// Position on the plane of a map projection, in its own units: x to the right, y upwards.
struct PlanePoint {
    double x = 0, y = 0;
};

/// Position of a picture on its plane, in the plane's units (metres of EPSG:3857 in Mercator).
struct PlanePosition {
    double left, top; ///< of the top left corner of the top left pixel
    double per_px;    ///< side of a pixel
};

/// Map projection by PROJ. Longitudes come first on every plane, regardless of the order of axes
/// that its authority states.
struct PlaneProjection {
    std::string crs; ///< as requested
    std::string wkt; ///< as WKT, for the files of other programs

    /// `std::nullopt` outside the domain of the projection.
    std::function<std::optional<PlanePoint>(const GeoPoint&)> to_plane;
    std::function<std::optional<GeoPoint>(const PlanePoint&)> to_geo;
};

/// Returns the projection of a projected or geographic coordinate reference system with two axes.
///
/// \param crs  any definition that PROJ reads: "EPSG:3006", a name, a PROJ string, WKT.
/// \throws InputError  if PROJ does not know it, or it is not such a system.
///
/// Transformations that need grids use the installed ones and never access the network.
std::shared_ptr<const PlaneProjection> plane_projection(const std::string& crs);

/// Entry point of the plug-in macadam_proj.
using ProjOpen = void(const std::string& crs, PlaneProjection& projection);
inline constexpr const char* proj_open_name = "macadam_proj_open";

} // namespace macadam
