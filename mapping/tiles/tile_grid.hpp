#pragma once

#include "estimator/common/geo.hpp"

#include <compare>
#include <cstdint>

namespace macadam {

/// A Web Mercator tile: zoom 0 has one tile, each zoom four times as many as the one before. x
/// grows eastwards from the antimeridian, y southwards from 85.0511 degrees north.
///
/// Source: OGC 17-083r2, "Two Dimensional Tile Matrix Set", annex D.1, WebMercatorQuad.
struct TileId {
    std::uint8_t zoom = 0;
    std::uint32_t x = 0; ///< 0 .. 2^zoom - 1
    std::uint32_t y = 0; ///< 0 .. 2^zoom - 1
    friend auto operator<=>(const TileId&, const TileId&) = default;
};

inline constexpr int max_zoom = 22; ///< a tile of 256 px is then 10 m wide at the equator

/// A position in tile coordinates of a zoom; the integer parts identify the tile.
struct TilePosition {
    double x = 0;
    double y = 0;
};

/// Converts a position to tile coordinates.
///
/// \param point  latitudes are clamped to 85.0511 degrees.
TilePosition tile_position(const GeoPoint& point, int zoom);
GeoPoint geo_point(const TilePosition& place, int zoom);

/// Returns the extent of a tile, enlarged by `margin` tiles on each side.
GeoBox tile_box(const TileId& tile, double margin = 0);

/// The tiles of a zoom that intersect a box.
struct TileRange {
    std::uint32_t first_x = 0, first_y = 0;
    std::uint32_t last_x = 0, last_y = 0; ///< inclusive
};
TileRange tiles_of(const GeoBox& box, int zoom);

} // namespace macadam
