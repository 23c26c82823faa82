#include "render/map/legend_band.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double max_around = 0.02; // share of roads around the data on ground taken as empty

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

} // namespace

LegendCard widest_card(const Legend& legend, double room_px, double unit, TypeSetter& setter) {
    auto best = legend_card(legend, 1, unit, setter);
    for (int columns = 2; columns <= int(legend.entries.size()); ++columns) {
        const auto card = legend_card(legend, columns, unit, setter);
        if (card.width_px <= room_px && card.height_px < best.height_px) {
            best = card;
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
    const double scale = std::min(room.width() / std::max(1e-12, data.width_rad),
                                  room.height() / std::max(1e-12, data.height_rad));
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
                       band.map.bottom - std::round(margin / 2) - band.card.height_px};
        band.card.framed = false;
        return band;
    }
    return {};
}

} // namespace macadam
