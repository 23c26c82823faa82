#include "render/map/sheet/event_symbols.hpp"

#include <algorithm>

namespace macadam {
namespace {

// Sizes at 1000 px.
constexpr double radius_px = 4;
constexpr double radius_a_severity_px = 1.3;
constexpr double casing_px = 1.5;

constexpr std::uint32_t event_rgb = 0x7b1fa2; // in none of the ramps, which go from red to blue

void draw_shape(DrawTarget& canvas,
                EventKind kind,
                const PixelPoint& middle,
                double radius,
                std::uint32_t rgb) {
    const auto& [x, y] = middle;
    switch (kind) {
    case EventKind::pothole:
        canvas.stroke(middle, middle, radius, rgb);
        return;
    case EventKind::bump:
        canvas.fill_triangle({x, y - 1.2 * radius},
                             {x + 1.2 * radius, y + 0.9 * radius},
                             {x - 1.2 * radius, y + 0.9 * radius},
                             rgb);
        return;
    case EventKind::joint:
        canvas.fill({{x - 0.9 * radius, y - 0.9 * radius, x + 0.9 * radius, y + 0.9 * radius}},
                    rgb);
        return;
    case EventKind::rail:
        const double half = 1.25 * radius;
        canvas.fill_triangle({x, y - half}, {x + half, y}, {x, y + half}, rgb);
        canvas.fill_triangle({x, y + half}, {x - half, y}, {x, y - half}, rgb);
        return;
    }
}

} // namespace

void draw_event(DrawTarget& canvas,
                const MapEvent& event,
                const PixelPoint& middle,
                double unit,
                const Palette& colours) {
    const double radius =
        unit * (radius_px + radius_a_severity_px * static_cast<double>(event.severity));
    draw_shape(canvas, event.kind, middle, radius + std::max(1.0, casing_px * unit), colours.page);
    draw_shape(canvas, event.kind, middle, radius, event_rgb);
}

void draw_events(DrawTarget& canvas,
                 std::span<const MapEvent> events,
                 const MapFrame& frame,
                 const PixelBox& map,
                 double unit,
                 const Palette& colours) {
    for (const auto severity : {Severity::low, Severity::moderate, Severity::high}) {
        for (const auto& event : events) {
            if (event.severity != severity) {
                continue;
            }
            const auto at = to_pixel(frame, event.at);
            const bool is_on_map =
                map.left <= at.x && at.x <= map.right && map.top <= at.y && at.y <= map.bottom;
            if (is_on_map) {
                draw_event(canvas, event, at, unit, colours);
            }
        }
    }
}

} // namespace macadam
