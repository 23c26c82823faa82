#pragma once

#include "storage/gdal/map_kind.hpp"

#include <filesystem>

namespace macadam {

/// Whether a database is a GeoPackage, MBTiles, or any other one, by its tables.
///
/// A database can hold what runs when it is read: virtual tables, whose modules open other files or
/// ask servers, and views, which call functions or never end. Only R-trees are let through, and in
/// MBTiles views that are no more than a look-up.
///
/// \throws InputError  if it holds others or cannot be read.
MapKind kind_of_sqlite_map(const std::filesystem::path& file);

/// Whether MBTiles hold vector tiles.
bool holds_vector_tiles(const std::filesystem::path& mbtiles);

/// Whether a GeoPackage has tables of tiles that are pictures.
bool holds_pictures(const std::filesystem::path& geopackage);

/// From now on no view, index or column of any database of this process can call functions that
/// are not SQLite's own harmless ones.
void distrust_schemas();

} // namespace macadam
