#pragma once

#include "storage/networks/network_reader.hpp"

#include <filesystem>
#include <functional>

namespace macadam {

// Interface between storage/networks/network_reader.cpp and the plug-in macadam_gdal.

/// Passes the drivable lines of a layer on, feature by feature, including those of fewer than two
/// points. Ids are unique, and nodes are numbered from 1 in the order of their first appearance.
///
/// \throws InputError  if the file is not a supported line layer, or has ids that are not whole
///                     numbers or not unique.
using OgrReadLines = void(const std::filesystem::path& file,
                          const LayerColumns& columns,
                          const std::function<void(Way)>& take);
inline constexpr const char* ogr_read_lines_name = "macadam_ogr_read_lines";

} // namespace macadam
