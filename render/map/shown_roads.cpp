#include "render/map/shown_roads.hpp"

#include "render/map/sheet/legend_placement.hpp"
#include "render/roads/line_joining.hpp"
#include "render/roads/map_generalisation.hpp"
#include "render/roads/road_painter.hpp"
#include "render/scene/colour.hpp"

#include <vector>

namespace macadam {
namespace {

/// Returns the widths, and whether both directions fit side by side.
LineWidths widths_of(const std::vector<MapLine>& lines,
                     const MapStyle& style,
                     const MapFrame& frame,
                     const Layout& layout) {
    const double unit = layout.paper_unit;
    auto wanted = line_widths(metres_per_px(frame, (layout.map.top + layout.map.bottom) / 2), unit);
    wanted.core_px *= style.lines.width;
    wanted.casing_px *= style.lines.casing;
    const double ink =
        ink_per_px(joined_polylines(lines, worse_of_both_ways(lines), frame), layout.map, unit);
    const auto separate = uncrowded(wanted, 2 * ink, unit);
    if (separate.separate_ways) {
        return separate;
    }
    wanted.separate_ways = false;
    return uncrowded(wanted, ink, unit);
}

} // namespace

ShownRoads shown_roads(const MapScene& scene,
                       const MapStyle& style,
                       const MapFrame& frame,
                       const Layout& layout) {
    const auto& table = classes_of(style);
    check_classes(scene.lines, table);
    auto lines = scene.lines;
    if (scene.projection) {
        for (auto& line : lines) {
            line.line = bent(frame, line.line);
        }
    }
    const auto widths = widths_of(lines, style, frame, layout);
    const auto uses = widths.separate_ways ? all_lines(lines) : worse_of_both_ways(lines);
    join_short_classes(lines, uses, table, min_run_mm * scale_denominator_of(frame, layout) / 1000);
    return {widths.separate_ways
                ? side_by_side(lines, frame, widths, style.left_hand_traffic, joined_polylines)
                : joined_polylines(lines, uses, frame),
            widths};
}

} // namespace macadam
