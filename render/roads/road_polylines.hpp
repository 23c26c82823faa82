#pragma once

#include "render/roads/line_joining.hpp"
#include "render/roads/stroke_geometry.hpp"

#include <span>
#include <vector>

namespace macadam {

/// How a piece is painted, numbered in painting order: what is worse covers what is better, what is
/// certain covers what is not.
constexpr int look_of(int iri_class, bool certain) {
    return 2 + 2 * iri_class + (certain ? 1 : 0);
}

inline constexpr int max_classes = 31; ///< that looks can tell apart
constexpr int unmeasured_look = 0;
constexpr int few_passes_look = 1;

int line_look(const MapLine& line);

/// A chain of lines on the picture, without points that nobody could tell apart.
Polyline
strand_of(std::span<const MapLine> lines, const std::vector<LineUse>& chain, const MapFrame& frame);

} // namespace macadam
