#pragma once

#include "mapping/tiles/tile_grid.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace macadam::testing {

/// Content of a PMTiles archive, read by the specification (version 3) without Macadam's code.
struct ReadPmTiles {
    std::map<TileId, std::string> tiles;
    std::string metadata; ///< JSON
    std::uint64_t addressed_tiles = 0;
    std::uint64_t entries = 0;
    std::uint64_t contents = 0;
    bool clustered = false;
    int tile_compression = 0;
    int tile_type = 0;
    int min_zoom = 0;
    int max_zoom = 0;
    double west_deg = 0, south_deg = 0, east_deg = 0, north_deg = 0;
    int centre_zoom = 0;
    std::uint64_t root_ends_at = 0;
    std::size_t leaves = 0; ///< directories below the root
};
ReadPmTiles read_pmtiles(const std::filesystem::path& file);

/// Unpacks a gzip member.
std::string unzipped(const std::string& packed);

/// Encodes a picture of a single grey.
std::string grey_png(std::uint32_t size_px, std::uint8_t grey);

} // namespace macadam::testing
