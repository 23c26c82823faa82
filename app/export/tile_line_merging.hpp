#pragma once

#include "mapping/style/iri_class.hpp"
#include "render/projection/tile_pixel_grid.hpp"
#include "render/scene/scene.hpp"
#include "storage/store/road_store.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// How segments become the lines of tiles of one zoom. All counts are of segments by their number
/// along the way, powers of two, so that they begin at the same places in every tile.
struct TileLineRules {
    std::uint32_t per_line;  ///< neighbours that look alike are one line, up to so many
    std::uint32_t per_value; ///< so many show one class: that of their mean IRI
    bool separate_ways;      ///< each direction has a line; else both share the worse of the two
    double margin_m; ///< around a tile: lines that end at a line on the tile are there whole
};

/// A line is as long as 8 pixels or as one segment, and one class holds for 2 pixels (at the
/// equator) or one segment, whichever is longer.
///
/// \param reach_px  how far a line reaches from its places
TileLineRules tile_line_rules(const WorldScale& scale, double segment_length_m, double reach_px);

/// The roads in a box grown by the rules' margin, in the order of keys, as TilePainter wants them.
/// A line that shows a mean counts as measured if at least half of its segments are, and as certain
/// if at least half of these are; it has few passes if more than half of these have.
std::vector<MapLine> tile_lines(const RoadStore& store,
                                const GeoBox& box,
                                const TileLineRules& rules,
                                const ClassTable& classes,
                                int min_passes = 1);

} // namespace macadam
