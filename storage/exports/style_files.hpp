#pragma once

#include "mapping/style/iri_class.hpp"

#include <filesystem>

namespace macadam {

/// Writes NAME.qml and NAME.sld beside a layer of segments, where QGIS and other programs look for
/// its style. Files there that this program did not write, such as a style that the user saved in
/// QGIS, stay.
///
/// \throws InputError  if they cannot be written.
void write_style_files(const std::filesystem::path& layer, const ClassTable& classes);

} // namespace macadam
