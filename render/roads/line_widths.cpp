#include "render/roads/line_widths.hpp"

#include "mapping/style/road_widths.hpp"
#include "render/scene/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_set>

namespace macadam {
namespace {

constexpr double max_ink = 0.5; // share of the ground near roads
constexpr double ink_to_separate = 0.6;
constexpr double min_core_px = 1.3; // a thinner line is mostly casing
constexpr double thinnest_core_px = 0.9;
constexpr double thinnest_casing_px = 0.35;
constexpr double uncertain_part = 0.55;  // relative width of uncertain lines
constexpr double unmeasured_core = 0.75; // relative width, less prominent
constexpr double cell_px = 64;           // neighbourhood size, in a picture of 1000 px

bool inside(const PixelBox& box, const PixelPoint& point) {
    return box.left <= point.x && point.x <= box.right && box.top <= point.y &&
           point.y <= box.bottom;
}

} // namespace

LineWidths line_widths(double metres_per_px, double unit) {
    auto widths = tile_widths(zoom_of_metres_per_px(metres_per_px * unit));
    widths.core_px = std::max(min_core_px, widths.core_px * unit);
    widths.casing_px *= unit;
    return widths;
}

LineWidths tile_widths(double zoom) {
    const double core_px = road_width_px(zoom);
    return {.core_px = core_px,
            .casing_px = road_casing_px(core_px),
            .separate_ways = zoom >= RoadWidths::separate_zoom};
}

double rank_factor(int rank) {
    constexpr std::array factors{1.3, 1.2, 1.1, 1.0, 0.9, 0.8};
    return factors[std::size_t(std::clamp(rank, 0, 5))];
}

double ink_per_px(std::span<const Polyline> polylines, const PixelBox& visible, double unit) {
    const double side_px = cell_px * unit;
    std::unordered_set<std::uint64_t> cells;
    double length_px = 0;
    for (const auto& polyline : polylines) {
        for (std::size_t i = 0; i < polyline.looks.size(); ++i) {
            const auto& a = polyline.points[i];
            const auto& b = polyline.points[i + 1];
            const double piece_px = std::hypot(b.x - a.x, b.y - a.y);
            const int steps = int(std::min(4096.0, 1 + piece_px / side_px));
            for (int step = 0; step < steps; ++step) {
                const double t = (step + 0.5) / steps;
                const PixelPoint at{std::lerp(a.x, b.x, t), std::lerp(a.y, b.y, t)};
                if (inside(visible, at)) {
                    length_px += piece_px / steps;
                    cells.insert(std::uint64_t(at.y / side_px) << 32 |
                                 std::uint64_t(at.x / side_px));
                }
            }
        }
    }
    return cells.empty() ? 0 : length_px / (double(cells.size()) * side_px * side_px);
}

LineWidths uncrowded(const LineWidths& widths, double ink_per_px, double unit) {
    const double ink = ink_per_px * (widths.core_px + 2 * widths.casing_px);
    if (ink <= max_ink) {
        return widths;
    }
    const double thinner = max_ink / ink;
    // Lines thinner than a pixel of the final picture lose their colour.
    const double real_px = std::max(1.0, std::sqrt(unit));
    return {.core_px = std::max(std::min(widths.core_px, thinnest_core_px * real_px),
                                widths.core_px * thinner),
            .casing_px = std::max(std::min(widths.casing_px, thinnest_casing_px * real_px),
                                  widths.casing_px * thinner * thinner),
            .separate_ways = widths.separate_ways && thinner > ink_to_separate};
}

double core_radius_px(const LineWidths& widths, int rank, bool certain) {
    return widths.core_px * rank_factor(rank) / 2 * (certain ? 1 : uncertain_part);
}

double casing_radius_px(const LineWidths& widths, int rank, bool certain) {
    return core_radius_px(widths, rank, certain) + widths.casing_px;
}

double unmeasured_radius_px(const LineWidths& widths, int rank) {
    return core_radius_px(widths, rank, true) * unmeasured_core;
}

double unmeasured_edge_radius_px(const LineWidths& widths, int rank) {
    return unmeasured_radius_px(widths, rank) + widths.casing_px;
}

double subject_edge_radius_px(const LineWidths& widths) {
    constexpr double edge = 0.35; // of the core's width
    return core_radius_px(widths, subject_rank, true) +
           std::max(2 * widths.casing_px, edge * widths.core_px);
}

double subject_air_radius_px(const LineWidths& widths) {
    constexpr double air = 0.5; // of the core's width
    return subject_edge_radius_px(widths) + std::max(2 * widths.casing_px, air * widths.core_px);
}

double way_offset_px(const LineWidths& widths, int rank) {
    // The casings of the two directions overlap to one line, as wide as each of them.
    return widths.core_px * rank_factor(rank) / 2 + widths.casing_px / 2;
}

} // namespace macadam
