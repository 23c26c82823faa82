#include "app/export/tile_square_painter.hpp"

#include "app/export/tile_line_merging.hpp"
#include "render/labels/label_placement.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace macadam {

TileSquarePainter::TileSquarePainter(StoreReader store, MapStyle style, int tile_px, int square_px)
    : store_{std::move(store)}, style_{std::move(style)}, tile_px_{tile_px},
      painter_{{style_, tile_px, square_px / tile_px}}, png_{style_}, empty_{png_.empty(tile_px)} {}

void TileSquarePainter::draw(const TileSquare& square, const Put& put) {
    const auto lines = lines_of(square);
    std::optional<Image> image;
    if (!lines.empty()) {
        image = painter_.draw(square.first, lines);
    }
    const auto& [first, wanted] = square;
    for (auto y = wanted.first_y; y <= wanted.last_y; ++y) {
        for (auto x = wanted.first_x; x <= wanted.last_x; ++x) {
            const PictureCut cut{static_cast<int>(x - first.x) * tile_px_,
                                 static_cast<int>(y - first.y) * tile_px_,
                                 tile_px_};
            put(TileId{first.zoom, x, y}, image ? png_.encode(*image, cut) : empty_);
        }
    }
}

/// Returns the lines of all label cells with wanted tiles. Other tiles are drawn but not taken.
std::vector<MapLine> TileSquarePainter::lines_of(const TileSquare& square) const {
    const WorldScale scale{square.first.zoom, tile_px_};
    const auto cell = static_cast<std::uint32_t>(label_cell_px / tile_px_);
    const auto last = (std::uint32_t{1} << unsigned(scale.zoom)) - 1;
    const auto& wanted = square.wanted;
    const auto north_west =
        tile_box({square.first.zoom, wanted.first_x / cell * cell, wanted.first_y / cell * cell});
    const auto south_east = tile_box({square.first.zoom,
                                      std::min(wanted.last_x / cell * cell + cell - 1, last),
                                      std::min(wanted.last_y / cell * cell + cell - 1, last)});
    return tile_lines(
        store_,
        {.west_deg = north_west.west_deg,
         .south_deg = south_east.south_deg,
         .east_deg = south_east.east_deg,
         .north_deg = north_west.north_deg},
        tile_line_rules(scale, store_.settings().segment_length_m, painter_.reach_px(scale.zoom)),
        *style_.classes,
        style_.min_passes);
}

} // namespace macadam
