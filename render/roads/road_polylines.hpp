#pragma once

#include "render/roads/line_joining.hpp"
#include "render/roads/line_widths.hpp"
#include "render/roads/stroke_geometry.hpp"

#include <span>
#include <vector>

namespace macadam {

/// Returns the look of a line segment, numbered in painting order: worse covers better, certain
/// covers uncertain.
constexpr int look_of(int iri_class, bool certain) {
    return 2 + 2 * iri_class + (certain ? 1 : 0);
}

inline constexpr int max_classes = 31; ///< maximum number of classes in looks
constexpr int unmeasured_look = 0;
constexpr int few_passes_look = 1;

int line_look(const MapLine& line);

/// Projects a chain of lines to the picture, without indistinguishable points.
Polyline polyline_of(std::span<const MapLine> lines,
                     const std::vector<LineUse>& chain,
                     const MapFrame& frame);

/// Maker of polylines of the lines that are used.
using MakePolylines = std::vector<Polyline> (*)(std::span<const MapLine> lines,
                                                const std::vector<LineUse>& uses,
                                                const MapFrame& frame);

/// Makes one polyline of each chain of neighbours, for a picture that is drawn from one set of
/// lines.
std::vector<Polyline> joined_polylines(std::span<const MapLine> lines,
                                       const std::vector<LineUse>& uses,
                                       const MapFrame& frame);

/// Makes one polyline of each line, in their order, with the nearest line segments of its
/// neighbours undrawn at its ends. A polyline depends on its line and the next two lines on either
/// side only, so that pictures drawn from different sets of lines agree where these do.
std::vector<Polyline> separate_polylines(std::span<const MapLine> lines,
                                         const std::vector<LineUse>& uses,
                                         const MapFrame& frame);

/// Makes the polylines of both directions of roads, each offset to its side.
std::vector<Polyline> side_by_side(std::span<const MapLine> lines,
                                   const MapFrame& frame,
                                   const LineWidths& widths,
                                   bool left_hand_traffic,
                                   MakePolylines polylines);

/// Checks the classes of lines.
/// \throws InputError  if the table has none or too many, or a line's class is not in it.
void check_classes(std::span<const MapLine> lines, const ClassTable& table);

} // namespace macadam
