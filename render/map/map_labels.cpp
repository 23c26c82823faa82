#include "render/map/map_labels.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

// Sizes at 1000 px.
constexpr double label_px = 13;
constexpr double halo_px = 2;
constexpr double repeat_px = 420;
constexpr double edge_px = 6;
constexpr double legend_air_px = 8;

constexpr double min_label_px = 10; // minimum legible size
constexpr double min_halo_px = 1.5;
constexpr double base_map_halo = 1.6; // relative to that on plain ground

/// Returns the distance from the centre of a road to the edge of its painted line.
double painted_half_width_px(const LineWidths& widths, const MapLine& line) {
    if (line.iri_class < 0) {
        return core_radius_px(widths, line.rank, true);
    }
    return casing_radius_px(widths, line.rank, line.certain || line.few_passes) +
           (widths.separate_ways && line.both_ways ? way_offset_px(widths, line.rank) : 0);
}

} // namespace

LabelConfig label_config(double unit) {
    return {.size_px = std::max(min_label_px, label_px * unit),
            .halo_px = std::max(min_halo_px, halo_px * unit),
            .gap_px = unit,
            .repeat_px = repeat_px * unit};
}

std::vector<RoadName> road_names(std::span<const MapLine> lines,
                                 const MapFrame& frame,
                                 const LineWidths& widths,
                                 const std::function<bool(const MapLine&)>& is_named) {
    std::vector<RoadName> names;
    names.reserve(lines.size());
    for (const auto& line : lines) {
        RoadName road{.line = {},
                      .name = is_named(line) ? line.name : "",
                      .rank = std::clamp(line.rank, 0, 5),
                      .quiet = line.iri_class < 0,
                      .half_width_px = painted_half_width_px(widths, line)};
        road.line.reserve(line.line.size());
        for (const auto& point : line.line) {
            road.line.push_back(to_pixel(frame, point));
        }
        names.push_back(std::move(road));
    }
    return names;
}

std::vector<Label> map_labels(const MapScene& scene,
                              const MapStyle& style,
                              const Layout& layout,
                              const Placement& placement,
                              const LineWidths& widths,
                              TypeSetter& setter) {
    if (!style.labels) {
        return {};
    }
    LabelCell cell{.box = inset(layout.map, std::round(edge_px * layout.unit)), .kept_free = {}};
    if (!placement.card.legend.entries.empty()) {
        const auto& corner = placement.corner;
        cell.kept_free.push_back(inset({corner.x,
                                        corner.y,
                                        corner.x + placement.card.width_px,
                                        corner.y + placement.card.height_px},
                                       -legend_air_px * layout.unit));
    }
    auto config = label_config(layout.unit);
    if (scene.base) {
        config.halo_px *= base_map_halo;
    }
    const auto names =
        road_names(scene.lines, placement.frame, widths, [](const MapLine&) { return true; });
    return placed_labels(names, cell, config, setter);
}

} // namespace macadam
