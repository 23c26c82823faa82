#pragma once

#include "storage/store/reader/store_reader.hpp"

#include <filesystem>

namespace macadam {

/// Writes a project for QGIS 3.22 or later (.qgz): the layer `roughness` of the database, at its
/// path relative to the project, with its style, over tiles of OpenStreetMap, which QGIS loads when
/// the project is opened.
///
/// \throws InputError  if the file cannot be written.
void write_qgis_project(const StoreReader& store, const std::filesystem::path& file);

} // namespace macadam
