#include "render/tiles/tile_painter.hpp"

#include "estimator/common/error.hpp"
#include "render/labels/label_painter.hpp"
#include "render/roads/road_painter.hpp"
#include "render/roads/road_polylines.hpp"
#include "render/tiles/tile_labels.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr int min_tile_px = 64;
constexpr int max_tile_px = 4096;
constexpr int max_side_px = 8192;

const TileLook& checked(const TileLook& look) {
    if (look.tile_px < min_tile_px || look.tile_px > max_tile_px) {
        throw InputError{fmt::format(
            "tile size '{}', expected {} to {} px", look.tile_px, min_tile_px, max_tile_px)};
    }
    if (look.across < 1 || look.across > max_side_px / look.tile_px) {
        throw InputError{fmt::format("'{}' tiles of {} px across, expected 1 to {}",
                                     look.across,
                                     look.tile_px,
                                     max_side_px / look.tile_px)};
    }
    return look;
}

LineWidths widths_of(const MapStyle& style, const WorldScale& scale) {
    auto widths = tile_widths(zoom_of_256_px(scale));
    widths.core_px *= style.lines.width;
    widths.casing_px *= style.lines.casing;
    return widths;
}

/// Limits Mesa to one thread, since its threads mostly wait for each other; use processes for
/// parallel drawing.
const TileLook& with_one_thread(const TileLook& look) {
    setenv("LP_NUM_THREADS", "0", 0);
    return look;
}

Sheet sheet_of(const WorldWindow& window) {
    const auto left_px = double(window.left_px);
    const auto top_px = double(window.top_px);
    return {.width_px = window.side_px,
            .height_px = window.side_px,
            .map = {left_px, top_px, left_px + window.side_px, top_px + window.side_px},
            .left_px = left_px,
            .top_px = top_px};
}

Image with_labels(Image roads,
                  std::span<const Label> labels,
                  const WorldWindow& window,
                  const Palette& colours,
                  TypeSetter& setter) {
    if (labels.empty()) {
        return roads;
    }
    Canvas canvas{std::move(roads)};
    draw_labels(canvas,
                labels,
                {int(window.left_px), int(window.top_px)},
                {colours.ink, colours.quiet_ink, colours.ground},
                setter);
    return std::move(canvas).finished();
}

} // namespace

struct TilePainter::Impl {
    explicit Impl(const TileLook& wanted)
        : look{with_one_thread(checked(wanted))}, colours{palette(look.style)},
          roads{colours, class_colours(look.style, classes_of(look.style).classes.size())} {}

    TileLook look;
    TypeSetter setter;
    Palette colours;
    RoadPainter roads;
};

TilePainter::TilePainter(const TileLook& look) : impl_{std::make_unique<Impl>(look)} {}
TilePainter::~TilePainter() = default;
TilePainter::TilePainter(TilePainter&&) noexcept = default;
TilePainter& TilePainter::operator=(TilePainter&&) noexcept = default;

Image TilePainter::draw(const TileId& first,
                        std::span<const MapLine> lines,
                        const TileBackground* background) {
    auto& [look, setter, colours, roads] = *impl_;
    check_classes(lines, classes_of(look.style));
    const auto window = window_of(first, look.tile_px, look.across);
    const auto frame = world_frame(window.scale);
    const auto widths = widths_of(look.style, window.scale);
    const auto strands =
        widths.separate_ways
            ? side_by_side(lines, frame, widths, look.style.left_hand_traffic, separate_polylines)
            : separate_polylines(lines, worse_of_both_ways(lines), frame);
    auto sheet = sheet_of(window);
    std::vector<PointName> places;
    if (background != nullptr) {
        sheet.ground = tile_ground(background->tiles, window, look.style.theme, colours.ground);
        places = tile_places(background->places, window.scale);
    }
    roads.begin(std::move(sheet), strands, widths);
    auto image = roads.rows(0, window.side_px);
    if (!look.style.labels) {
        return image;
    }
    return with_labels(std::move(image),
                       tile_labels(lines, places, window, widths, setter),
                       window,
                       colours,
                       setter);
}

double TilePainter::reach_px(int zoom) const {
    const auto widths = widths_of(impl_->look.style, {zoom, impl_->look.tile_px});
    // At bends, the offset of a line is at most doubled.
    return 2 * way_offset_px(widths, 0) + casing_radius_px(widths, 0, true) + 1;
}

} // namespace macadam
