#pragma once

#include "storage/gdal/map_kind.hpp"

#include <filesystem>

namespace macadam {

/// Classifies a database as GeoPackage, MBTiles or other SQLite by its tables.
///
/// A database may contain code that runs when it is read: virtual tables, whose modules open other
/// files or contact servers, and views, which call functions or never terminate. Only R-trees are
/// accepted, and in MBTiles also views that are plain look-ups.
///
/// \throws InputError  if the database contains other virtual tables or views, or cannot be read.
MapKind kind_of_sqlite_map(const std::filesystem::path& file);

/// Tests whether an MBTiles file holds vector tiles.
bool holds_vector_tiles(const std::filesystem::path& mbtiles);

/// Tests whether a GeoPackage has tables of image tiles.
bool holds_pictures(const std::filesystem::path& geopackage);

/// Restricts the schemas of all databases of this process: from now on, views, indexes and columns
/// can call only SQLite's own harmless functions.
void distrust_schemas();

} // namespace macadam
