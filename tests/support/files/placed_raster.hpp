#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace macadam::testing {

/// A raster of red, green and blue that GDAL's own tools place on the globe.
struct PlacedRaster {
    std::string crs; ///< "EPSG:4326"
    double left, top, per_px;
    int width_px, height_px;
    std::string more{}; ///< options of gdal_translate
};

using ColourOf = std::function<std::vector<std::uint8_t>(int x, int y)>;

/// Writes it as a GeoTIFF, or as what its suffix and `more` say.
std::filesystem::path
write_raster(const std::filesystem::path& file, const PlacedRaster& raster, const ColourOf& colour);

/// Its place is to be read in its colours: red is the column and green the row, in pixels.
std::vector<std::uint8_t> place_as_colour(int x, int y);

/// Places on one coordinate reference system, x first, as gdaltransform puts them on another.
struct Coordinates {
    double x, y;
};
std::vector<Coordinates> transformed(const std::filesystem::path& folder,
                                     const std::vector<Coordinates>& places,
                                     const std::string& from,
                                     const std::string& to);

} // namespace macadam::testing
