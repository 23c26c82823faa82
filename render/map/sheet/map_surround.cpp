#include "render/map/sheet/map_surround.hpp"

#include "render/scene/scale_bar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace macadam {
namespace {

// Sizes at 1000 px.
constexpr double label_px = 14;

struct NorthArrow {
    PixelPoint foot;
    double turn_rad; ///< clockwise from up
};

PixelPoint turned(const PixelPoint& point, const PixelPoint& pivot, double turn_rad) {
    if (turn_rad == 0) { // avoids rounding
        return point;
    }
    const double x = point.x - pivot.x;
    const double y = point.y - pivot.y;
    return {pivot.x + x * std::cos(turn_rad) - y * std::sin(turn_rad),
            pivot.y + x * std::sin(turn_rad) + y * std::cos(turn_rad)};
}

void draw_north(DrawTarget& canvas,
                TypeSetter& setter,
                const NorthArrow& arrow,
                double unit,
                const Palette& colours) {
    const auto& foot = arrow.foot;
    const double height = 24 * unit;
    const double half = 6.5 * unit;
    const double notch = 5.5 * unit;
    const PixelPoint tip{foot.x, foot.y - height};
    const PixelPoint heart{foot.x, foot.y - notch};
    const auto fill =
        [&](const PixelPoint& a, const PixelPoint& b, const PixelPoint& c, std::uint32_t rgb) {
            const PixelPoint pivot{foot.x, foot.y - height / 2};
            canvas.fill_triangle(turned(a, pivot, arrow.turn_rad),
                                 turned(b, pivot, arrow.turn_rad),
                                 turned(c, pivot, arrow.turn_rad),
                                 rgb);
        };
    // The light half extends slightly under the dark one, so that no ground shows through the seam.
    const double under = 1;
    fill({tip.x - under, tip.y + 4 * under},
         {foot.x + half, foot.y},
         {heart.x - under, heart.y},
         colours.quiet_ink);
    fill(tip, {foot.x + half, foot.y}, heart, colours.quiet_ink);
    fill(tip, heart, {foot.x - half, foot.y}, colours.ink);
    const double aside = half + 4 * unit + 5 * unit * std::abs(std::sin(arrow.turn_rad));
    canvas.write(setter.mask("N", {label_px * unit, true}), {foot.x + aside, foot.y}, colours.ink);
}

void draw_scale(DrawTarget& canvas,
                TypeSetter& setter,
                const ScaleBar& bar,
                const PixelPoint& start,
                double unit,
                const Palette& colours) {
    const double thick = std::max(2.0, std::round(2.5 * unit));
    const double tick = std::round(8 * unit);
    const PixelBox line{start.x, start.y - thick, start.x + bar.width_px, start.y};
    canvas.fill({line}, colours.ink);
    canvas.fill({{line.left, line.bottom - tick, line.left + thick, line.bottom}}, colours.ink);
    canvas.fill({{line.right - thick, line.bottom - tick, line.right, line.bottom}}, colours.ink);
    const TextLook look{label_px * unit};
    const double width = setter.width_px(bar.label, look);
    canvas.write(setter.mask(bar.label, look),
                 {(line.left + line.right - width) / 2, line.top - 5 * unit},
                 colours.ink);
}

/// Returns the scale as it is stated on paper, such as "1:25,000".
std::string scale_text(const MapFrame& frame, const Layout& layout) {
    const auto number = std::llround(scale_denominator_of(frame, layout));
    return number < 1000 ? fmt::format("1:{}", number)
           : number < 1'000'000
               ? fmt::format("1:{},{:03}", number / 1000, number % 1000)
               : fmt::format(
                     "1:{},{:03},{:03}", number / 1'000'000, number / 1000 % 1000, number % 1000);
}

void draw_footer(DrawTarget& canvas,
                 TypeSetter& setter,
                 const Layout& layout,
                 const MapFrame& frame,
                 const MapStyle& style) {
    const auto colours = palette(style);
    const auto& room = layout.scale_room;
    const double unit = layout.unit;
    const double base = std::round((room.top + room.bottom) / 2 + 11 * unit);
    const PixelPoint heart_of_map{(layout.map.left + layout.map.right) / 2,
                                  (layout.map.top + layout.map.bottom) / 2};
    draw_north(canvas,
               setter,
               {{room.left + 7 * unit, base}, north_rad(frame, heart_of_map)},
               unit,
               colours);

    const double left = std::round(room.left + 46 * unit);
    const double middle = (layout.map.top + layout.map.bottom) / 2;
    const TextLook look{label_px * unit};
    const double gap = 14 * unit;
    const auto ratio = layout.is_on_paper ? scale_text(frame, layout) : std::string{};
    const double beside = ratio.empty() ? 0 : setter.width_px(ratio, look) + gap;
    const auto bar =
        scale_bar(metres_per_px(frame, middle), room.right - left - beside, style.in_per_mi);
    draw_scale(canvas, setter, bar, {left, base}, unit, colours);
    canvas.write(
        setter.mask(ratio, look), {std::round(left + bar.width_px + gap), base}, colours.ink);
}

void draw_edges(DrawTarget& canvas, const Layout& layout, const Palette& colours) {
    const double line = std::max(1.0, std::round(layout.unit));
    const auto& map = layout.map;
    if (map.top > 0) {
        canvas.fill({{map.left, map.top, map.right, map.top + line}}, colours.border);
    }
    canvas.fill({{map.left, map.bottom - line, map.right, map.bottom}}, colours.border);
    if (map.right < layout.width_px) {
        canvas.fill({{map.right - line, map.top, map.right, map.bottom}}, colours.border);
        canvas.fill({{map.right, map.bottom - line, layout.width_px, map.bottom}}, colours.border);
    }
    if (map.bottom < layout.scale_room.top) {
        const double bottom = layout.scale_room.top;
        canvas.fill({{map.left, bottom - line, layout.width_px, bottom}}, colours.border);
    }
}

} // namespace

void draw_map_surround(DrawTarget& canvas,
                       const Layout& layout,
                       const Placement& placement,
                       const MapStyle& style,
                       TypeSetter& setter) {
    const auto colours = palette(style);
    if (layout.edges) {
        draw_edges(canvas, layout, colours);
    }
    for (const auto& text : layout.texts) {
        canvas.write(setter.mask(text.text, text.look),
                     text.at,
                     text.quiet ? colours.quiet_ink : colours.ink);
    }
    if (layout.scale_bar) {
        draw_footer(canvas, setter, layout, placement.frame, style);
    }
    if (!placement.card.legend.entries.empty()) {
        draw_legend(canvas, setter, placement.card, placement.corner, colours);
    }
}

} // namespace macadam
