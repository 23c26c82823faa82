#pragma once

#include "mapping/style/iri_class.hpp"
#include "render/projection/tile_pixel_grid.hpp"
#include "render/scene/scene.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Rules that merge segments into the lines of tiles of one zoom. Counts are of segment numbers
/// along the way and powers of two, so that lines begin at the same positions in every tile.
struct TileLineRules {
    std::uint32_t per_line;  ///< maximum number of similar neighbours in a line
    std::uint32_t per_value; ///< number of segments with one class, that of their mean IRI
    bool separate_ways;      ///< one line per direction; otherwise both share the worse value
    double margin_m;         ///< around a tile: lines that end at a line on the tile are complete
};

/// Returns the rules of a zoom. A line is as long as 8 pixels or one segment, and one class holds
/// for 2 pixels (at the equator) or one segment, whichever is longer.
///
/// \param reach_px  extent of a drawn line around its positions
TileLineRules tile_line_rules(const WorldScale& scale, double segment_length_m, double reach_px);

/// Returns the roads in a box grown by the rules' margin, in key order, as TilePainter needs them.
/// A line that shows a mean counts as measured if at least half of its segments are measured, and
/// as certain if at least half of those are certain; it has few passes if more than half of those
/// have few.
std::vector<MapLine> tile_lines(const StoreReader& store,
                                const GeoBox& box,
                                const TileLineRules& rules,
                                const ClassTable& classes,
                                int min_passes = 1);

} // namespace macadam
