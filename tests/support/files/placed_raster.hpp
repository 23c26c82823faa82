#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace macadam::testing {

/// RGB raster that GDAL's own tools georeference.
struct PlacedRaster {
    std::string crs; ///< "EPSG:4326"
    double left, top, per_px;
    int width_px, height_px;
    std::string more{}; ///< options for gdal_translate
};

using ColourOf = std::function<std::vector<std::uint8_t>(int x, int y)>;

/// Writes the raster as a GeoTIFF, or in the format of its suffix and `more`.
std::filesystem::path
write_raster(const std::filesystem::path& file, const PlacedRaster& raster, const ColourOf& colour);

/// Returns a colour that encodes the pixel position: red is the column and green the row.
std::vector<std::uint8_t> place_as_colour(int x, int y);

/// Coordinates in a reference system, x first; transformed() converts them with gdaltransform.
struct Coordinates {
    double x, y;
};
std::vector<Coordinates> transformed(const std::filesystem::path& folder,
                                     const std::vector<Coordinates>& places,
                                     const std::string& from,
                                     const std::string& to);

} // namespace macadam::testing
