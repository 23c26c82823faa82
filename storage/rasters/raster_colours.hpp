#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

class GDALDataset;

namespace macadam {

using Rgba = std::array<std::uint8_t, 4>;

/// How the numbers of a raster's bands become colours.
struct RasterColours {
    std::vector<int> bands;  ///< one with a table, or red, green and blue; GDAL's numbers, from 1
    std::vector<Rgba> table; ///< of 256 colours, where there is one band

    /// Of three bands: where all of them have their number, the raster is transparent.
    std::array<std::optional<double>, 3> no_data{};
    int alpha_band = 0;  ///< 0: none
    bool masked = false; ///< GDAL's mask of the first band says where it is transparent
};

/// \throws InputError  with the file's name, if they are no colours of eight bits.
RasterColours colours_of(GDALDataset& raster, const std::string& file);

} // namespace macadam
