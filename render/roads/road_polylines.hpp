#pragma once

#include "render/roads/line_joining.hpp"
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
Polyline
strand_of(std::span<const MapLine> lines, const std::vector<LineUse>& chain, const MapFrame& frame);

} // namespace macadam
