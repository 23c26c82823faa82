#pragma once

#include "mapping/geometry/area.hpp"

#include <filesystem>
#include <vector>

namespace macadam {

// Interface between storage/surveys/area_file.cpp and the plug-in macadam_gdal.

/// Adds the polygons of the first layer that has some, in the order of its features.
///
/// \throws InputError  if the file is no map that GDAL reads here, or is damaged.
using ReadAreaLayer = void(const std::filesystem::path& file, std::vector<Polygon>& polygons);
inline constexpr const char* read_area_layer_name = "macadam_read_area_layer";

} // namespace macadam
