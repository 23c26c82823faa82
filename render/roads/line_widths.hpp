#pragma once

#include "render/roads/stroke_geometry.hpp"

#include <span>

namespace macadam {

/// Line widths of a map, px, for a road of medium rank.
struct LineWidths {
    double core_px;
    double casing_px;           ///< on each side
    bool separate_ways = false; ///< both directions of a road fit side by side
};

/// Returns the widths by the scale of a map, by the rule of RoadWidths.
///
/// \param unit  size of a pixel of that rule: 1/96 inch on paper, px
LineWidths line_widths(double metres_per_px, double unit);

/// Returns the widths for tiles, by zoom alone, so that adjacent tiles match.
///
/// \param zoom  of tiles of 256 px
LineWidths tile_widths(double zoom);

/// Returns the width factor of a rank: a motorway is slightly wider than a service road.
double rank_factor(int rank);

/// Returns the share of the ground near roads that lines of width 1 px would cover.
double ink_per_px(std::span<const Polyline> polylines, const PixelBox& visible, double unit);

/// Reduces the widths where roads are so dense that they would merge.
LineWidths uncrowded(const LineWidths& widths, double ink_per_px, double unit);

double core_radius_px(const LineWidths& widths, int rank, bool certain);
double casing_radius_px(const LineWidths& widths, int rank, bool certain);

/// Return the radii of a road without a measurement, which is less prominent, and of its edge on a
/// base map.
double unmeasured_radius_px(const LineWidths& widths, int rank);
double unmeasured_edge_radius_px(const LineWidths& widths, int rank);

/// Return the radii of the edge around a map's subject, and of the ground kept free around that.
double subject_edge_radius_px(const LineWidths& widths);
double subject_air_radius_px(const LineWidths& widths);

/// Returns the distance from the centre line of the road to that of one direction.
double way_offset_px(const LineWidths& widths, int rank);

} // namespace macadam
