#pragma once

#include "storage/styles/road_style.hpp"

#include <filesystem>

namespace macadam {

/// Writes NAME.qml and NAME.sld of a layer of segments, for which QGIS and other programs look
/// beside it. It leaves out those beside it that this program did not write, such as a style that
/// the user saved in QGIS.
///
/// \param layer   file of the layer, as named by the user
/// \param folder  in which they are written: that of the layer, or that of a set of files
/// \throws InputError  if they cannot be written.
void write_style_files(const std::filesystem::path& layer,
                       const std::filesystem::path& folder,
                       const RoadStyle& style);

} // namespace macadam
