#include "render/map/map_labels.hpp"

#include "render/map/sheet/map_insets.hpp"
#include "render/roads/map_generalisation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

// In 1/96 inch on paper.
constexpr double label_px = 10.2; // 2.7 mm, 7.7 pt
constexpr double halo_px = 1.6;
constexpr double repeat_px = 420; // 11 cm
constexpr double min_core = 0.9;  // 0.24 mm: a smaller junction is not seen as an area
constexpr double edge_px = 6;
constexpr double legend_air_px = 8;
constexpr double mark_air_px = 3; // around the outline of a detail

constexpr double min_label_px = 10; // minimum legible size
constexpr double min_halo_px = 1.5;
constexpr double base_map_halo = 1.6; // relative to that on plain ground

/// Look of the names of a rank of places.
struct PlaceLook {
    double size; ///< 1/96 inch
    bool bold;
    double to_scale; ///< shown down to it
};
constexpr int last_of_towns = 1; // of the ranks of places
constexpr std::array place_looks{PlaceLook{20, true, 1e9},
                                 PlaceLook{16, true, 2e6},
                                 PlaceLook{12.5, true, 3e5},
                                 PlaceLook{11, true, 7.5e4}};
constexpr PlaceLook marked_look{12.5, true, 1e12};
constexpr double marked_px = 6;

/// Returns the names of places at a scale, the important ones first. Names of areas are centred on
/// them; where the map is too small to show areas, a symbol marks the place.
std::vector<PointName> point_names(const MapScene& scene,
                                   const MapFrame& frame,
                                   double paper_unit,
                                   double scale_denominator) {
    auto places = scene.places;
    std::ranges::stable_sort(places, {}, &MapPlace::rank);
    std::vector<PointName> names;
    for (const auto& place : places) {
        const auto& [size, bold, to_scale] =
            place.is_marked
                ? marked_look
                : place_looks[std::size_t(std::clamp(place.rank, 0, int(place_looks.size()) - 1))];
        if (scale_denominator <= to_scale) {
            names.push_back({.at = to_pixel(frame, place.at),
                             .name = place.name,
                             .look = {std::max(min_label_px, size * paper_unit), bold},
                             .symbol_px = place.is_marked ? marked_px * paper_unit : 0,
                             .may_cover_measured = place.rank <= last_of_towns});
        }
    }
    return names;
}

LabelConfig label_config(double paper_unit) {
    return {.size_px = std::max(min_label_px, label_px * paper_unit),
            .min_size_px = min_label_px,
            .halo_px = std::max(min_halo_px, halo_px * paper_unit),
            .gap_px = paper_unit,
            .repeat_px = repeat_px * paper_unit,
            .min_core_px = min_core * paper_unit,
            .moves_others = true};
}

/// Returns the distance from the centre of a road to the edge of its painted line.
double painted_half_width_px(const LineWidths& widths, const MapLine& line) {
    if (line.iri_class < 0) {
        return core_radius_px(widths, line.rank, true);
    }
    if (line.rank == subject_rank) {
        return subject_edge_radius_px(widths);
    }
    return casing_radius_px(widths, line.rank, line.certain || line.few_passes) +
           (widths.separate_ways && line.both_ways ? way_offset_px(widths, line.rank) : 0);
}

} // namespace

std::vector<RoadName> road_names(std::span<const MapLine> lines,
                                 const MapFrame& frame,
                                 const LineWidths& widths,
                                 const std::function<bool(const MapLine&)>& is_named) {
    std::vector<RoadName> names;
    names.reserve(lines.size());
    for (const auto& line : lines) {
        const bool has_label = is_named(line);
        RoadName road{.line = {},
                      .name = has_label && line.name != line.number ? line.name : "",
                      .number = has_label ? line.number : "",
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
                              double scale_denominator,
                              TypeSetter& setter) {
    if (!style.labels) {
        return {};
    }
    LabelCell cell{.box = inset(layout.map, std::round(edge_px * layout.paper_unit)),
                   .kept_free = {}};
    if (!placement.card.legend.entries.empty()) {
        const auto& corner = placement.corner;
        cell.kept_free.push_back(inset({corner.x,
                                        corner.y,
                                        corner.x + placement.card.width_px,
                                        corner.y + placement.card.height_px},
                                       -legend_air_px * layout.paper_unit));
    }
    if (has_details(scene)) {
        for (const auto& mark : detail_marks(scene, placement.frame, layout)) {
            const double air = std::round(mark_air_px * layout.paper_unit);
            for (const double x : {mark.left, mark.right}) {
                cell.kept_free.push_back({x - air, mark.top, x + air, mark.bottom});
            }
            for (const double y : {mark.top, mark.bottom}) {
                cell.kept_free.push_back({mark.left, y - air, mark.right, y + air});
            }
            cell.kept_free.push_back(inset(detail_tab(mark, layout), -air));
        }
    }
    auto config = label_config(layout.paper_unit);
    if (scene.base) {
        config.halo_px *= base_map_halo;
    }
    const auto names = road_names(scene.lines, placement.frame, widths, [&](const MapLine& line) {
        return is_named(line.rank, scale_denominator);
    });
    const auto places = point_names(scene, placement.frame, layout.paper_unit, scale_denominator);
    return placed_labels(names, places, cell, config, setter);
}

} // namespace macadam
