#include "app/export/tile_square_painter.hpp"

#include "app/export/tile_line_merging.hpp"
#include "render/labels/label_placement.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace macadam {

TileSquarePainter::TileSquarePainter(StoreReader store, MapStyle style, int tile_px, int square_px)
    : store_{std::move(store)}, background_{store_},
      has_background_{!background_.size().is_empty()}, style_{std::move(style)}, tile_px_{tile_px},
      painter_{{style_, tile_px, square_px / tile_px}}, png_{style_, has_background_},
      empty_{png_.empty(tile_px)} {}

void TileSquarePainter::draw(const TileSquare& square, const Put& put) {
    const auto lines = lines_of(square);
    const auto background = background_of(square);
    std::optional<Image> image;
    if (!lines.empty() || !background.tiles.empty() || !background.places.empty()) {
        image = painter_.draw(square.first, lines, has_background_ ? &background : nullptr);
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

/// Returns the box of all label cells with wanted tiles. Other tiles are drawn but not taken.
GeoBox TileSquarePainter::box_of(const TileSquare& square) const {
    const auto zoom = square.first.zoom;
    const auto cell = static_cast<std::uint32_t>(label_cell_px / tile_px_);
    const auto last = (std::uint32_t{1} << unsigned{zoom}) - 1;
    const auto& wanted = square.wanted;
    const auto north_west =
        tile_box({zoom, wanted.first_x / cell * cell, wanted.first_y / cell * cell});
    const auto south_east = tile_box({zoom,
                                      std::min(wanted.last_x / cell * cell + cell - 1, last),
                                      std::min(wanted.last_y / cell * cell + cell - 1, last)});
    return {.west_deg = north_west.west_deg,
            .south_deg = south_east.south_deg,
            .east_deg = south_east.east_deg,
            .north_deg = north_west.north_deg};
}

std::vector<MapLine> TileSquarePainter::lines_of(const TileSquare& square) const {
    const WorldScale scale{square.first.zoom, tile_px_};
    return tile_lines(
        store_,
        box_of(square),
        tile_line_rules(scale, store_.settings().segment_length_m, painter_.reach_px(scale.zoom)),
        *style_.classes,
        style_.min_passes);
}

TileBackground TileSquarePainter::background_of(const TileSquare& square) const {
    const WorldScale scale{square.first.zoom, tile_px_};
    TileBackground background;
    if (has_background_ && zoom_of_256_px(scale) >= pictures_have_background_from) {
        const auto box = box_of(square);
        const double reach_deg = background_reach_px * 360 / std::ldexp(tile_px_, scale.zoom);
        background.tiles = background_.tiles(tile_background_level(scale),
                                             {.west_deg = box.west_deg - reach_deg,
                                              .south_deg = box.south_deg - reach_deg,
                                              .east_deg = box.east_deg + reach_deg,
                                              .north_deg = box.north_deg + reach_deg});
        background.places = background_.places(box);
    }
    return background;
}

} // namespace macadam
