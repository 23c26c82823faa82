#include "render/map/sheet/legend_placement.hpp"

#include "mapping/geometry/line_clipping.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace macadam {
namespace {

constexpr double mm_per_unit = 25.4 / 96; // of Layout::paper_unit
constexpr double min_scale = 0.9;         // of a small map, relative to its scale without a legend
constexpr double max_strip = 0.15;        // of the map's height; a higher legend is shortened
constexpr double max_around = 0.02;       // share of roads around the data on ground taken as empty

bool passes_through(const PixelBox& box, const PixelPoint& a, const PixelPoint& b) {
    const auto [left, right] = std::minmax(a.x, b.x);
    const auto [top, bottom] = std::minmax(a.y, b.y);
    if (right < box.left || left > box.right || bottom < box.top || top > box.bottom) {
        return false;
    }
    return !clipped_line(a, b, {box.left, box.top, box.right, box.bottom}).is_empty();
}

/// Returns the possible places of the card, the best first: the corners, then along the edges.
std::vector<PixelPoint> places_of(const PixelBox& map, const LegendCard& card) {
    const double margin = std::round(card_margin_px * card.unit);
    const double left = map.left + margin;
    const double right = map.right - margin - card.width_px;
    const double top = map.top + margin;
    const double bottom = map.bottom - margin - card.height_px;
    std::vector<PixelPoint> places{{right, bottom}, {left, bottom}, {right, top}, {left, top}};
    for (const double x : {right, left}) {
        for (const double share : {0.75, 0.5, 0.25}) {
            places.push_back({x, std::round(top + share * (bottom - top))});
        }
    }
    for (const double y : {bottom, top}) {
        for (const double share : {0.75, 0.25, 0.5}) {
            places.push_back({std::round(left + share * (right - left)), y});
        }
    }
    return places;
}

constexpr std::size_t corners = 4; ///< first of places_of

PixelBox ground_of(const LegendCard& card, const PixelPoint& corner) {
    const double air = 10 * card.unit;
    return inset({corner.x, corner.y, corner.x + card.width_px, corner.y + card.height_px}, -air);
}

/// Tells on which places the card would hide roads.
std::vector<bool> hides_roads(const MapScene& scene,
                              const MapFrame& frame,
                              const LegendCard& card,
                              const std::vector<PixelPoint>& places) {
    std::vector<PixelBox> grounds;
    grounds.reserve(places.size());
    for (const auto& place : places) {
        grounds.push_back(ground_of(card, place));
    }
    std::vector<bool> hidden(places.size());
    for (const auto& line : scene.lines) {
        for (std::size_t i = 0; i + 1 < line.line.size(); ++i) {
            const auto a = to_pixel(frame, line.line[i]);
            const auto b = to_pixel(frame, line.line[i + 1]);
            for (std::size_t place = 0; place < places.size(); ++place) {
                hidden[place] = hidden[place] || passes_through(grounds[place], a, b);
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

    const auto left_frame = map_frame(scene, layout, left_room);
    const auto upper_frame = map_frame(scene, layout, upper_room);
    const bool is_beside = left_frame.px_per_rad >= upper_frame.px_per_rad;
    const auto& frame = is_beside ? left_frame : upper_frame;
    const auto& card = is_beside ? column : row;
    const auto corner = places_of(layout.map, card)[is_beside ? 0 : 1];
    const bool hides = hides_roads(scene, frame, card, {corner}).front();
    return {frame, card, corner, true, hides};
}

/// Places the legend where no roads are, or where the data makes room for it.
Placement placement_beside_roads(const MapScene& scene,
                                 const Legend& legend,
                                 const MapFrame& frame,
                                 const Layout& layout,
                                 TypeSetter& setter) {
    double height_px = layout.map.height();
    std::optional<Placement> at_edge;
    for (int columns = 1; columns <= int(legend.entries.size()); ++columns) {
        const auto card = legend_card(legend, columns, layout.unit, setter);
        const double margin = 2 * card_margin_px * layout.unit;
        if (card.width_px > layout.map.width() - margin || card.height_px >= height_px) {
            continue;
        }
        height_px = card.height_px;
        const auto places = places_of(layout.map, card);
        const auto hidden = hides_roads(scene, frame, card, places);
        const auto place = std::size_t(std::ranges::find(hidden, false) - hidden.begin());
        if (place < corners) {
            return {frame, card, places[place], false};
        }
        if (place < places.size() && !at_edge) {
            at_edge = Placement{frame, card, places[place], false};
        }
    }
    return at_edge ? *at_edge : beside_or_below(scene, legend, layout, setter);
}

/// Returns true if the sheet is so small that its letters are relatively larger than on other
/// sheets.
bool has_large_letters(const Layout& layout) {
    const double side_px = std::min(layout.map.width(), layout.scale_room.bottom);
    return layout.unit * 1000 > side_px * 1.001;
}

/// Tells whether there are roads to show and hardly any of them lies around the data.
bool is_empty_around(const MapScene& scene) {
    const auto& box = scene.box;
    const auto around = std::ranges::count_if(scene.lines, [&](const MapLine& line) {
        if (line.line.empty()) {
            return false;
        }
        const auto& point = line.line.front();
        return point.lat_deg < box.south_deg || point.lat_deg > box.north_deg ||
               point.lon_deg < box.west_deg || point.lon_deg > box.east_deg;
    });
    return !scene.lines.empty() && double(around) <= max_around * double(scene.lines.size());
}

/// Returns the next number of two figures: 26,000 of 25,300.
double rounded_up(double number) {
    const double unit = std::pow(10.0, std::floor(std::log10(number)) - 1);
    return std::ceil(number / unit - 1e-9) * unit;
}

} // namespace

double scale_denominator_of(const MapFrame& frame, const Layout& layout) {
    const double middle_px = (layout.map.top + layout.map.bottom) / 2;
    return metres_per_px(frame, middle_px) * layout.paper_unit / mm_per_unit * 1000;
}

MapFrame map_frame(const MapScene& scene, const Layout& layout, const PixelBox& room) {
    auto frame = fitted_frame(scene.box, room, scene.projection.get());
    const double wanted = scene.scale_denominator > 0 ? scene.scale_denominator
                          : layout.is_on_paper && !scene.to_the_edge
                              ? rounded_up(scale_denominator_of(frame, layout))
                              : 0;
    if (wanted > 0) {
        // Twice: the latitude at half the map's height depends on the scale.
        frame.px_per_rad *= scale_denominator_of(frame, layout) / wanted;
        frame.px_per_rad *= scale_denominator_of(frame, layout) / wanted;
    }
    return frame;
}

Placement placement_of(const MapScene& scene,
                       const Legend& legend,
                       const Layout& layout,
                       TypeSetter& setter) {
    const double margin = scene.to_the_edge ? 0 : map_margin_px * layout.unit;
    const auto frame = map_frame(scene, layout, inset(layout.map, margin));
    if (legend.entries.empty()) {
        return {frame};
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

std::optional<LegendBand>
legend_band(const MapScene& scene, const Legend& legend, const Layout& layout, TypeSetter& setter) {
    if (legend.entries.empty() || scene.to_the_edge || scene.base || !is_empty_around(scene)) {
        return {};
    }
    const double margin = card_margin_px * layout.unit;
    const auto room = inset(layout.map, map_margin_px * layout.unit);
    const auto data = plane_extent(scene.box, scene.projection.get());
    const double scale = map_frame(scene, layout, room).px_per_rad;
    LegendBand band{.map = layout.map, .card = {}, .corner = {}};

    band.card = widest_card(legend, layout.map.width() - 2 * margin, layout.unit, setter);
    const double below = std::ceil(band.card.height_px + margin);
    if (room.height() - scale * data.height_rad >= below) {
        band.map.bottom -= below;
        band.corner = {band.map.left + std::round(margin / 2),
                       band.map.bottom + std::round(margin / 2)};
        band.card.framed = false;
        return band;
    }
    band.card = legend_card(legend, 1, layout.unit, setter);
    const double beside = std::ceil(band.card.width_px + margin);
    if (room.width() - scale * data.width_rad >= beside) {
        band.map.right -= beside;
        band.corner = {band.map.right + std::round(margin / 2),
                       band.map.top + std::round(margin / 2)};
        band.card.framed = false;
        return band;
    }
    return {};
}

LegendBand legend_strip(const Legend& legend, const Layout& layout, TypeSetter& setter) {
    const double margin = card_margin_px * layout.unit;
    LegendBand band{.map = layout.map, .card = {}, .corner = {}};
    for (const auto& form : forms_of(legend)) {
        band.card = widest_card(form, layout.map.width() - 2 * margin, layout.unit, setter);
        if (band.card.height_px <= max_strip * layout.map.height()) {
            break;
        }
    }
    band.card.framed = false;
    band.map.bottom -= std::ceil(band.card.height_px + margin);
    band.corner = {band.map.left + std::round(margin / 2),
                   band.map.bottom + std::round(margin / 2)};
    return band;
}

double empty_share(const MapScene& scene, const Layout& layout, const Placement& placement) {
    const double sheet = layout.width_px * layout.scale_room.bottom;
    const double around = sheet - layout.whole_map.width() * layout.whole_map.height();
    const auto overlap_of = [](const PixelBox& a, const PixelBox& b) {
        return std::max(0.0, std::min(a.right, b.right) - std::max(a.left, b.left)) *
               std::max(0.0, std::min(a.bottom, b.bottom) - std::max(a.top, b.top));
    };
    const auto& shown = is_empty(scene.data_box) ? scene.box : scene.data_box;
    const auto extent = plane_extent(shown, scene.projection.get());
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

} // namespace macadam
