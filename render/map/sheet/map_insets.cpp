#include "render/map/sheet/map_insets.hpp"

#include "render/map/sheet/legend.hpp"
#include "render/projection/projection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace macadam {
namespace {

constexpr double most_share = 0.32; // of the sheet: insets are square, or flatter in a column
constexpr double min_mark_px = 9;   // side of a part on the locator, at 1000 px

constexpr double min_panel = 0.18;     // of the map's side: else there is no room for details
constexpr double max_panel = 0.6;      // likewise: else the map would be the smaller part
constexpr double min_detail = 150;     // side of a detail, 1/96 inch on paper: 40 mm
constexpr double detail_shape = 1.3;   // width / height, about that of a screen
constexpr std::size_t max_details = 3; // more would be smaller than they are worth
constexpr double min_enlarged = 2.5;   // of a detail over its map
constexpr double min_denominator = 2500;
constexpr double letter_px = 14; // of a detail's mark, at 1000 px

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

/// Returns the legend with all entries that lines can bring.
Legend fullest_legend(const MapScene& scene, const MapStyle& style) {
    MapScene all;
    all.class_km = scene.class_km;
    all.lines.resize(2); // the first without a measurement
    all.lines.back().iri_class = 0;
    all.lines.back().certain = false;
    if (style.min_passes > 1) {
        all.lines.push_back(all.lines.back());
        all.lines.back().few_passes = true;
    }
    return legend_of(all, style, classes_of(style));
}

/// Divides a room into maps side by side or one above the other, along its longer side.
std::vector<PixelBox> divided(const PixelBox& room, std::size_t count, double air) {
    std::vector<PixelBox> boxes;
    const bool is_row = room.width() > room.height();
    const double length = (is_row ? room.width() : room.height()) + air;
    for (std::size_t i = 0; i < count; ++i) {
        const double from = std::round(double(i) * length / double(count));
        const double to = std::round(double(i + 1) * length / double(count) - air);
        boxes.push_back(is_row ? PixelBox{room.left + from, room.top, room.left + to, room.bottom}
                               : PixelBox{room.left, room.top + from, room.right, room.top + to});
    }
    return boxes;
}

/// Returns the side of a panel that the data leaves free; 0 if it is too small.
double panel_side(double free_px, double side_px) {
    return free_px < min_panel * side_px ? 0 : std::round(std::min(free_px, max_panel * side_px));
}

} // namespace

std::optional<DetailLayout> detail_layout(const MapScene& scene,
                                          const MapStyle& style,
                                          const Layout& layout,
                                          std::size_t count,
                                          TypeSetter& setter) {
    const double margin = 2 * map_margin_px * layout.unit;
    const double air = std::round(card_margin_px * layout.unit / 2);
    const auto data = plane_extent(scene.box, scene.projection.get());
    const auto& whole = layout.whole_map;
    const double shape = data.width_rad / std::max(1e-12, data.height_rad);
    DetailLayout parts{.map = whole, .legend = {}, .boxes = {}};
    auto panel = whole;
    const double beside =
        panel_side(whole.width() - ((whole.height() - margin) * shape + margin), whole.width());
    const double below =
        panel_side(whole.height() - ((whole.width() - margin) / shape + margin), whole.height());
    if (beside > 0) {
        parts.map.right = panel.left = whole.right - beside;
    } else if (below > 0) {
        parts.map.bottom = panel.top = whole.bottom - below;
    } else {
        return {};
    }
    panel = {std::round(panel.left + air),
             std::round(panel.top + air),
             std::round(panel.right - air),
             std::round(panel.bottom - air)};
    const auto card = widest_card(fullest_legend(scene, style), panel.width(), layout.unit, setter);
    parts.legend = panel;
    parts.legend.bottom = panel.top + card.height_px;
    const PixelBox room{panel.left, parts.legend.bottom + air, panel.right, panel.bottom};
    double nearest = std::numeric_limits<double>::infinity();
    const double min_px = std::max(double(min_image_px), min_detail * layout.paper_unit);
    for (std::size_t n = count > 0 ? count : 1; n <= (count > 0 ? count : max_details); ++n) {
        auto boxes = divided(room, n, air);
        const auto& first = boxes.front();
        if (first.width() < min_px || first.height() < min_px) {
            break;
        }
        const double away = std::abs(std::log(first.width() / first.height() / detail_shape));
        if (away < nearest) {
            nearest = away;
            parts.boxes = std::move(boxes);
        }
    }
    return parts.boxes.empty() ? std::nullopt : std::optional{std::move(parts)};
}

std::optional<double> detail_scale(double map_scale_denominator) {
    const double most = map_scale_denominator / min_enlarged;
    if (!(most >= min_denominator)) {
        return {};
    }
    const double power = std::pow(10.0, std::floor(std::log10(most)));
    for (const double digits : {7.5, 5.0, 4.0, 3.0, 2.5, 2.0, 1.5}) {
        if (digits * power <= most) {
            return digits * power;
        }
    }
    return power;
}

bool has_details(const MapScene& scene) {
    return !scene.insets.empty() && scene.insets.front().scale_denominator > 0;
}

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

MapScene detail_scene(const MapScene& scene, std::size_t detail) {
    const auto& inset = scene.insets[detail];
    auto part = inset_scene(scene, inset);
    part.title = std::string(1, char('A' + int(detail))) + "   " + inset.name;
    part.scale_denominator = inset.scale_denominator;
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

std::vector<PixelBox>
detail_marks(const MapScene& scene, const MapFrame& frame, const Layout& layout) {
    std::vector<PixelBox> marks;
    for (const auto& inset : scene.insets) {
        const auto a = to_pixel(frame, {inset.box.north_deg, inset.box.west_deg});
        const auto b = to_pixel(frame, {inset.box.south_deg, inset.box.east_deg});
        marks.push_back({std::round(std::max(a.x, layout.map.left)),
                         std::round(std::max(a.y, layout.map.top)),
                         std::round(std::min(b.x, layout.map.right)),
                         std::round(std::min(b.y, layout.map.bottom))});
    }
    return marks;
}

PixelBox detail_tab(const PixelBox& mark, const Layout& layout) {
    const double side = std::round(20 * layout.unit);
    return {mark.left, mark.top, mark.left + side, mark.top + side};
}

void draw_detail_marks(DrawTarget& target,
                       const MapScene& scene,
                       const MapFrame& frame,
                       const Layout& layout,
                       const Palette& colours,
                       TypeSetter& setter) {
    const double line = std::max(1.0, std::round(1.5 * layout.unit));
    const TextLook look{letter_px * layout.unit, true};
    std::string letter = "A";
    for (const auto& mark : detail_marks(scene, frame, layout)) {
        outline(target, mark, line, colours.ink);
        const auto tab = detail_tab(mark, layout);
        target.fill({{tab.left, tab.top, tab.right, tab.bottom}}, colours.ink);
        target.write(setter.mask(letter, look),
                     {std::round(tab.left + (tab.width() - setter.width_px(letter, look)) / 2),
                      std::round(tab.top + tab.height() * 0.76)},
                     colours.page);
        ++letter[0];
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
