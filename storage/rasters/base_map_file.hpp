#pragma once

#include "mapping/style/base_map.hpp"

#include <filesystem>

namespace macadam {

/// Opens a raster that GDAL reads as a base map: GeoTIFF, MBTiles, GeoPackage, VRT, a picture with
/// world file and coordinate system. Colours are grey, a palette, red, green and blue, of eight
/// bits or fewer; "no data" and alpha are transparent.
///
/// It may be in any projection. A place of the picture is taken to the raster through PROJ on a
/// grid of 16 pixels, exactly where that is not straight to a twentieth of a pixel. Of its smaller
/// copies (overviews, zoom levels) the one is read that fits the whole picture best; where it has
/// none, means are made while it is read. Between pixels, and over several, a tent is laid: linear
/// where the raster is enlarged, a weighted mean where it is made smaller.
///
/// Nothing is fetched from the network. What is held goes with the part that is asked for, not with
/// the raster.
///
/// \throws InputError  if there is no such file, it is no raster, holds other than colours, or does
///                     not say where it lies.
BaseMap open_base_map(const std::filesystem::path& file);

} // namespace macadam
