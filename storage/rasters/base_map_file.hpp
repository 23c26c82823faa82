#pragma once

#include "mapping/style/base_map.hpp"

#include <filesystem>

namespace macadam {

/// Opens a raster that GDAL reads as a base map: GeoTIFF, MBTiles, GeoPackage, VRT, or an image
/// with a world file and coordinate system. Colours are grey, a palette, or red, green and blue, of
/// at most eight bits; "no data" and alpha are transparent.
///
/// The raster may be in any projection. Positions are transformed to it by PROJ on a grid of 16
/// pixels and interpolated; where the interpolation error exceeds a twentieth of a pixel, each
/// pixel is transformed. The overview or zoom level that best fits the whole picture is read; if
/// there is none, pixels are averaged while reading. Resampling uses a tent filter: bilinear where
/// the raster is enlarged, a weighted mean where it is reduced.
///
/// No data are fetched from the network. Memory depends on the requested part, not on the size of
/// the raster.
///
/// \throws InputError  if the file does not exist, is not a raster, holds values other than
///                     colours, or is not georeferenced.
BaseMap open_base_map(const std::filesystem::path& file);

} // namespace macadam
