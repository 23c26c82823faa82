#pragma once

#include "mapping/geometry/area.hpp"

#include <filesystem>

namespace macadam {

/// Reads an area: all polygons of the first layer with polygons in a GeoJSON, GeoPackage,
/// Shapefile, KML or other file that GDAL reads, in any coordinate system. Lines and points are
/// ignored.
///
/// \throws InputError  if the file is no such layer or holds no polygon.
Area read_area(const std::filesystem::path& file);

} // namespace macadam
