#include "render/map/map_insets.hpp"

#include "render/map/legend.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double most_share = 0.32; // of the sheet: insets are square, or flatter in a column
constexpr double min_mark_px = 9;   // side of a part on the locator, at 1000 px

GeoBox around_both(const GeoBox& a, const GeoBox& b) {
    return including(including(a, {b.south_deg, b.west_deg}), {b.north_deg, b.east_deg});
}

GeoPoint middle_of(const GeoBox& box) {
    return {(box.south_deg + box.north_deg) / 2, (box.west_deg + box.east_deg) / 2};
}

void outline(DrawTarget& target, const PixelBox& box, double line_px, std::uint32_t rgb) {
    target.fill({{box.left, box.top, box.right, box.top + line_px}}, rgb);
    target.fill({{box.left, box.bottom - line_px, box.right, box.bottom}}, rgb);
    target.fill({{box.left, box.top, box.left + line_px, box.bottom}}, rgb);
    target.fill({{box.right - line_px, box.top, box.right, box.bottom}}, rgb);
}

} // namespace

std::optional<InsetLayout> inset_layout(const Layout& layout, std::size_t insets) {
    const auto count = double(insets + 1);
    const double air = std::round(card_margin_px * layout.unit / 2);
    InsetLayout divided{layout.whole_map, {}};
    auto& map = divided.map;
    const bool is_column = map.width() >= map.height();
    if (is_column) {
        map.right =
            std::round(map.right - std::min(map.width() * most_share, map.height() / count));
    } else {
        map.bottom =
            std::round(map.bottom - std::min(map.height() * most_share, map.width() / count));
    }
    const PixelBox room = is_column
                              ? PixelBox{map.right, map.top, layout.whole_map.right, map.bottom}
                              : PixelBox{map.left, map.bottom, map.right, layout.whole_map.bottom};
    const double step = ((is_column ? room.height() : room.width()) - air) / count;
    for (double i = 0; i < count; ++i) {
        const double from = air + std::floor(i * step);
        const double to = std::floor((i + 1) * step);
        const PixelBox box =
            is_column
                ? PixelBox{room.left + air, room.top + from, room.right - air, room.top + to}
                : PixelBox{room.left + from, room.top + air, room.left + to, room.bottom - air};
        if (box.width() < min_image_px || box.height() < min_image_px) {
            return {};
        }
        divided.boxes.push_back({std::round(box.left),
                                 std::round(box.top),
                                 std::round(box.right),
                                 std::round(box.bottom)});
    }
    return divided;
}

MapScene inset_scene(const MapScene& scene, const MapInset& inset) {
    MapScene part;
    part.box = inset.box;
    part.title = inset.name;
    part.projection = scene.projection;
    part.base = scene.base;
    return part;
}

MapScene locator_scene(const MapScene& scene) {
    MapScene all;
    all.box = scene.box;
    all.projection = scene.projection;
    all.places.push_back({.name = scene.place, .at = middle_of(scene.box), .is_marked = true});
    for (const auto& inset : scene.insets) {
        all.box = around_both(all.box, inset.box);
        all.places.push_back({.name = inset.name, .at = middle_of(inset.box), .is_marked = true});
    }
    return all;
}

void draw_inset_panel(DrawTarget& target,
                      const Layout& layout,
                      std::span<const PixelBox> boxes,
                      const Palette& colours) {
    const double line = std::max(1.0, std::round(layout.unit));
    for (const auto& box : boxes) {
        outline(target, inset(box, -line), line, colours.border);
    }
}

void draw_locator(DrawTarget& target,
                  const MapScene& scene,
                  const PixelBox& box,
                  const MapFrame& frame,
                  double unit,
                  const Palette& colours) {
    const auto mark = [&](const GeoBox& part, double line_px) {
        const auto a = to_pixel(frame, {part.north_deg, part.west_deg});
        const auto b = to_pixel(frame, {part.south_deg, part.east_deg});
        const double x = box.left + (a.x + b.x) / 2;
        const double y = box.top + (a.y + b.y) / 2;
        const double half_width = std::max(min_mark_px * unit, b.x - a.x) / 2;
        const double half_height = std::max(min_mark_px * unit, b.y - a.y) / 2;
        outline(target,
                {std::round(x - half_width),
                 std::round(y - half_height),
                 std::round(x + half_width),
                 std::round(y + half_height)},
                line_px,
                colours.ink);
    };
    const double line = std::max(1.0, std::round(unit));
    mark(scene.box, 2 * line);
    for (const auto& inset : scene.insets) {
        mark(inset.box, line);
    }
}

} // namespace macadam
