#pragma once

#include <cstdint>
#include <filesystem>

namespace macadam {

/// Map file formats read through GDAL, each by one driver.
enum class MapKind : std::uint8_t {
    unknown,
    geopackage,
    sqlite,
    mbtiles,
    shapefile,
    geojson,
    geojson_lines,
    flatgeobuf,
    gml,
    kml,
    mapinfo,
    file_geodatabase,
    geotiff,
    png,
    jpeg,
    jpeg_2000,
    webp,
    virtual_raster,
};

/// Detects the format of a file from its first bytes, regardless of its name. SQLite databases
/// other than GeoPackage and MBTiles are `sqlite`.
///
/// \throws InputError  if the file cannot be read or is a database that could execute foreign code
///                     (storage/gdal/sqlite_map.hpp).
MapKind kind_of_map(const std::filesystem::path& file);

/// GDAL's name of the driver.
const char* driver_of(MapKind kind);

bool may_hold_lines(MapKind kind);
bool may_hold_pictures(MapKind kind);

} // namespace macadam
