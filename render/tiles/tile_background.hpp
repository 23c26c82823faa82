#pragma once

#include "mapping/background/background_levels.hpp"
#include "mapping/background/background_pieces.hpp"
#include "mapping/style/base_map.hpp"
#include "render/labels/label_placement.hpp"
#include "render/projection/tile_pixel_grid.hpp"
#include "render/scene/scene.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// Areas, lines and names that picture tiles show below and beside the roads.
struct TileBackground {
    std::vector<BackgroundTile> tiles; ///< of tile_background_level()
    std::vector<PlaceName> places;     ///< the most important first
};

/// Smallest zoom of tiles of 256 px with a background.
inline constexpr int pictures_have_background_from = 6;

/// Farthest that the background's lines are painted from their points, pixels.
inline constexpr double background_reach_px = 4;

/// Returns the level that serves the tiles of a scale.
const BackgroundLevel& tile_background_level(const WorldScale& scale);

/// Paints the background under a window of the world. A pixel depends on its position in the world
/// and on the pieces near it alone.
///
/// \param tiles  those that meet the window grown by background_reach_px
/// \throws InputError  if the pieces are damaged.
PaintPart tile_ground(std::span<const BackgroundTile> tiles,
                      const WorldWindow& window,
                      MapStyle::Theme theme,
                      std::uint32_t ground_rgb);

/// Returns the names of places on the plane of the whole world's pixels, as its zoom shows them.
std::vector<PointName> tile_places(std::span<const PlaceName> places, const WorldScale& scale);

} // namespace macadam
