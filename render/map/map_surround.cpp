#include "render/map/map_surround.hpp"

#include "mapping/geometry/line_clipping.hpp"
#include "render/map/legend.hpp"
#include "render/scene/scale_bar.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace macadam {
namespace {

// Sizes at 1000 px.
constexpr double label_px = 14;

constexpr double min_scale = 0.9; // of a small map, relative to its scale without a legend

bool passes_through(const PixelBox& box, const PixelPoint& a, const PixelPoint& b) {
    return !clipped_line(a, b, {box.left, box.top, box.right, box.bottom}).is_empty();
}

using Corners = std::array<PixelPoint, 4>;

/// Returns the possible corners of the card, the best first.
Corners corners_of(const PixelBox& map, const LegendCard& card) {
    const double margin = std::round(card_margin_px * card.unit);
    const double left = map.left + margin;
    const double right = map.right - margin - card.width_px;
    const double top = map.top + margin;
    const double bottom = map.bottom - margin - card.height_px;
    return {{{right, bottom}, {left, bottom}, {right, top}, {left, top}}};
}

PixelBox ground_of(const LegendCard& card, const PixelPoint& corner) {
    const double air = 10 * card.unit;
    return inset({corner.x, corner.y, corner.x + card.width_px, corner.y + card.height_px}, -air);
}

using Hidden = std::array<bool, 4>;

/// Tells which corners would hide roads.
Hidden hides_roads(const MapScene& scene,
                   const MapFrame& frame,
                   const LegendCard& card,
                   const Corners& corners) {
    std::array<PixelBox, 4> grounds;
    std::ranges::transform(corners, grounds.begin(), [&](const PixelPoint& corner) {
        return ground_of(card, corner);
    });
    Hidden hidden{};
    for (const auto& line : scene.lines) {
        for (std::size_t i = 0; i + 1 < line.line.size(); ++i) {
            const auto a = to_pixel(frame, line.line[i]);
            const auto b = to_pixel(frame, line.line[i + 1]);
            for (std::size_t corner = 0; corner < corners.size(); ++corner) {
                hidden[corner] = hidden[corner] || passes_through(grounds[corner], a, b);
            }
        }
        if (std::ranges::find(hidden, false) == hidden.end()) {
            break;
        }
    }
    return hidden;
}

Placement beside_or_below(const MapScene& scene,
                          const Legend& legend,
                          const Layout& layout,
                          TypeSetter& setter) {
    const double margin = map_margin_px * layout.unit;
    const double card_margin = card_margin_px * layout.unit;
    const auto column = legend_card(legend, 1, layout.unit, setter);
    const auto row = widest_card(legend, layout.map.width() - 2 * card_margin, layout.unit, setter);
    auto left_room = inset(layout.map, margin);
    left_room.right -= std::min(column.width_px + card_margin, left_room.width() * 0.6);
    auto upper_room = inset(layout.map, margin);
    upper_room.bottom -= std::min(row.height_px + card_margin, upper_room.height() * 0.6);

    const auto left_frame = fitted_frame(scene.box, left_room, scene.projection.get());
    const auto upper_frame = fitted_frame(scene.box, upper_room, scene.projection.get());
    if (left_frame.px_per_rad >= upper_frame.px_per_rad) {
        return {left_frame, column, corners_of(layout.map, column)[0]};
    }
    return {upper_frame, row, corners_of(layout.map, row)[1]};
}

/// Places the legend in a corner without roads, or where the data makes room for it.
Placement placement_beside_roads(const MapScene& scene,
                                 const Legend& legend,
                                 const MapFrame& frame,
                                 const Layout& layout,
                                 TypeSetter& setter) {
    double height_px = layout.map.height();
    for (int columns = 1; columns <= int(legend.entries.size()); ++columns) {
        const auto card = legend_card(legend, columns, layout.unit, setter);
        const double margin = 2 * card_margin_px * layout.unit;
        if (card.width_px > layout.map.width() - margin || card.height_px >= height_px) {
            continue;
        }
        height_px = card.height_px;
        const auto corners = corners_of(layout.map, card);
        const auto hidden = hides_roads(scene, frame, card, corners);
        const auto* const empty = std::ranges::find(hidden, false);
        if (empty != hidden.end()) {
            return {frame, card, corners[std::size_t(empty - hidden.begin())]};
        }
    }
    return beside_or_below(scene, legend, layout, setter);
}

/// Returns true if the sheet is so small that its letters are relatively larger than on other
/// sheets.
bool has_large_letters(const Layout& layout) {
    const double side_px = std::min(layout.map.width(), layout.scale_room.bottom);
    return layout.unit * 1000 > side_px * 1.001;
}

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
    const auto bar = scale_bar(metres_per_px(frame, middle), room.right - left, style.in_per_mi);
    draw_scale(canvas, setter, bar, {left, base}, unit, colours);
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

Placement placement_of(const MapScene& scene,
                       const Legend& legend,
                       const Layout& layout,
                       TypeSetter& setter) {
    const double margin = scene.to_the_edge ? 0 : map_margin_px * layout.unit;
    const auto frame = fitted_frame(scene.box, inset(layout.map, margin), scene.projection.get());
    if (legend.entries.empty()) {
        return {frame, {}, {}};
    }
    auto best = placement_beside_roads(scene, legend, frame, layout, setter);
    if (!has_large_letters(layout)) {
        return best;
    }
    for (const auto& form : forms_of(legend)) {
        if (best.frame.px_per_rad >= min_scale * frame.px_per_rad) {
            break;
        }
        const auto placement = placement_beside_roads(scene, form, frame, layout, setter);
        if (placement.frame.px_per_rad > best.frame.px_per_rad) {
            best = placement;
        }
    }
    return best;
}

double empty_share(const MapScene& scene, const Layout& layout, const Placement& placement) {
    const double sheet = layout.width_px * layout.scale_room.bottom;
    const double around = sheet - layout.whole_map.width() * layout.whole_map.height();
    const auto overlap_of = [](const PixelBox& a, const PixelBox& b) {
        return std::max(0.0, std::min(a.right, b.right) - std::max(a.left, b.left)) *
               std::max(0.0, std::min(a.bottom, b.bottom) - std::max(a.top, b.top));
    };
    const auto extent = plane_extent(scene.box, scene.projection.get());
    const double half_width = extent.width_rad * placement.frame.px_per_rad / 2;
    const double half_height = extent.height_rad * placement.frame.px_per_rad / 2;
    const auto& centre = placement.frame.centre;
    const PixelBox data{centre.x - half_width,
                        centre.y - half_height,
                        centre.x + half_width,
                        centre.y + half_height};
    const auto& corner = placement.corner;
    const PixelBox card{corner.x,
                        corner.y,
                        corner.x + placement.card.width_px,
                        corner.y + placement.card.height_px};
    const double filled =
        overlap_of(data, layout.map) + overlap_of(card, layout.whole_map) - overlap_of(card, data);
    return 1 - (around + filled) / sheet;
}

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
