#pragma once

#include "mapping/background/background.hpp"
#include "mapping/background/background_levels.hpp"
#include "mapping/background/background_pieces.hpp"
#include "mapping/tiles/tile_grid.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Smallest zoom whose tiles have a background.
inline constexpr int background_from_zoom = 6;

/// Layer of the background of vector tiles.
struct BackgroundLayer {
    std::string_view name;
    int min_zoom;
};

/// Returns the layers from the lowest to the topmost (docs/reference/vector-tiles.md).
std::span<const BackgroundLayer> background_layers();

/// Returns the level that serves the tiles of a zoom.
const BackgroundLevel& background_level_of_zoom(int zoom);

/// Encodes the layers of a tile's background, uncompressed; other layers of the tile may follow.
///
/// \param tiles   of the level of its zoom, those that meet it
/// \param places  any; those outside the tile are not shown
/// \throws InputError  if the pieces are damaged.
std::string background_layers_of(const TileId& tile,
                                 std::span<const BackgroundTile> tiles,
                                 std::span<const PlaceName> places);

} // namespace macadam
