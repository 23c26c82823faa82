#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace macadam {

/// Kinds of map files that are read by GDAL, each by one driver of it.
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

/// The kind of a file by its first bytes, whatever its name; databases that are no GeoPackage and
/// no MBTiles are `sqlite`.
///
/// \throws InputError  if the file cannot be read or is a database that others' code could run in
///                     (storage/gdal/sqlite_map.hpp).
MapKind kind_of_map(const std::filesystem::path& file);

/// The name of the driver, as GDAL calls it.
const char* driver_of(MapKind kind);

bool may_hold_lines(MapKind kind);
bool may_hold_pictures(MapKind kind);

} // namespace macadam
