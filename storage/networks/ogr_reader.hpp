#pragma once

#include "storage/networks/network_reader.hpp"

#include <filesystem>
#include <functional>

namespace macadam {

// What storage/networks/network_reader.cpp asks of the plug-in macadam_gdal.

/// Hands over the drivable lines of a layer, feature by feature, with ids that occur once and nodes
/// numbered from 1 in the order in which they first appear; also those of fewer than two points.
///
/// \throws InputError  if the file is no line layer that we know, or has ids that are not whole
///                     numbers or occur twice.
using OgrReadLines = void(const std::filesystem::path& file,
                          const LayerColumns& columns,
                          const std::function<void(Way)>& take);
inline constexpr const char* ogr_read_lines_name = "macadam_ogr_read_lines";

} // namespace macadam
