#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

class GDALDataset;

namespace macadam {

using Rgba = std::array<std::uint8_t, 4>;

/// Mapping of the band values of a raster to colours.
struct RasterColours {
    std::vector<int> bands;  ///< one with a table, or red, green and blue; GDAL's numbers, from 1
    std::vector<Rgba> table; ///< 256 colours, for a single band

    /// No-data values of three bands: a pixel is transparent where all bands have their value.
    std::array<std::optional<double>, 3> no_data{};
    int alpha_band = 0;  ///< 0 = none
    bool masked = false; ///< GDAL's mask of the first band gives the transparency
};

/// Reads the colour mapping of a raster.
///
/// \throws InputError  with the name of the file, if the values are not colours of eight bits.
RasterColours colours_of(GDALDataset& raster, const std::string& file);

} // namespace macadam
