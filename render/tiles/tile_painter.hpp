#pragma once

#include "render/projection/tile_pixel_grid.hpp"
#include "render/scene/scene.hpp"
#include "render/tiles/tile_background.hpp"

#include <memory>
#include <span>

namespace macadam {

struct TileLook {
    MapStyle style;
    int tile_px = 256; ///< side of a tile
    int across = 1;    ///< n: n x n tiles are drawn at once
};

/// Draws web map tiles with the painter of maps: the ground or a background, roads without a
/// measurement in light grey, then every measured road as a core of its class's colour in a casing.
///
/// A pixel depends on its position in the world and on the lines near it, not on the tile: tiles
/// drawn one by one are, byte for byte, the parts of one large picture. Widths therefore depend on
/// the zoom alone, and names lie completely in squares of the world that are labelled
/// independently. Below zoom 13 (of tiles of 256 px) the two directions of a road are one line of
/// the worse class; from there on each is drawn on its own side.
///
/// The painter holds one OpenGL context, bound to the thread that draws first. Drawing in parallel
/// requires several processes, not threads: fork before the first tile is drawn.
class TilePainter {
public:
    /// \throws InputError  if a tile is not 64 to 4096 px or the picture larger than 8192 px, or
    /// the
    ///                     ramp is unknown
    explicit TilePainter(const TileLook& look);
    ~TilePainter();
    TilePainter(TilePainter&&) noexcept;
    TilePainter& operator=(TilePainter&&) noexcept;

    /// Draws the tiles starting at `first` in the north-west.
    ///
    /// \param lines  all lines within reach_px() of the tiles, and all lines that share an end
    ///               point with one of these; in the same order for every tile. Distant lines cost
    ///               little. With labels, all lines of every label cell that a tile touches
    ///               (label_cell_px).
    /// \param background  null for plain ground, the same for all tiles of a zoom: pieces of the
    ///                    tiles that meet these, grown by background_reach_px; with labels, all
    ///                    places of every label cell that a tile touches
    /// \throws InputError  if a line's class is not in the table, the background is damaged, or
    ///                     OpenGL cannot draw
    Image draw(const TileId& first,
               std::span<const MapLine> lines,
               const TileBackground* background = nullptr);

    /// Returns the maximum distance of a line's painted pixels from its points.
    double reach_px(int zoom) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
