#pragma once

#include "render/projection/tile_pixel_grid.hpp"
#include "render/scene/scene.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace macadam {

struct TileLook {
    MapStyle style;
    int tile_px = 256; ///< side of a tile
    int across = 1;    ///< n: n x n tiles are drawn as one
};

/// Draws tiles of the web's map: the ground, roads without a measurement in quiet grey, then every
/// measured road as a core of its class's colour in a casing.
///
/// A pixel depends on its place in the world and on the lines near it, not on the tile: tiles drawn
/// one by one are, byte for byte, the parts of one large picture. So widths go by the zoom alone,
/// and names stand wholly in squares of the world that are labelled each for itself.
/// Below zoom 13 (of tiles of 256 px) the two directions of a road are one line of the worse class;
/// from there on each lies at its own side.
///
/// Keeps one OpenGL context, which is of the thread that made it. Several processes draw at once,
/// several threads do not: fork before the first one is made.
class TilePainter {
public:
    /// \throws InputError  if a tile is not 64 to 4096 px or the picture larger than 8192 px, the
    ///                     ramp is unknown, or OSMesa cannot draw.
    explicit TilePainter(const TileLook& look);
    ~TilePainter();
    TilePainter(TilePainter&&) noexcept;
    TilePainter& operator=(TilePainter&&) noexcept;

    /// The tiles from `first`, in the north-west, on.
    ///
    /// \param lines  all that come within reach_px() of them, with all that end where one of these
    ///               ends; in the same order for every tile. What is far away costs little. With
    ///               labels all of every label cell that a tile touches (label_cell_px).
    /// \throws InputError  if a line's class is not in the table
    Image draw(const TileId& first, std::span<const MapLine> lines);

    /// How far a line that is drawn reaches from its places, at most.
    double reach_px(int zoom) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
