#pragma once

namespace macadam {

/// Widths of roads' lines by the scale of a map: 1 px at zoom 10 to 6 px at zoom 16 and on to 9,
/// growing by half per zoom. Zooms are those of web maps with tiles of 256 px, so that a map on
/// paper has the zoom at which 1/96 inch of it is a pixel.
struct RoadWidths {
    static constexpr double px_mm = 25.4 / 96; ///< a pixel of these widths on paper
    static constexpr double first_zoom = 10;
    static constexpr double growth_per_zoom = 1.5;
    static constexpr double min_px = 1;
    static constexpr double max_px = 9;
    static constexpr double casing_px = 0.3; ///< of a line without width
    static constexpr double casing_share = 0.22;
    static constexpr double min_casing_px = 0.5;
    static constexpr double max_casing_px = 1.6;
    static constexpr double separate_zoom = 13; ///< from here, both directions lie side by side

    /// The width at a zoom is constant + growing * 1.5^(zoom - 10), so that it is 6 px at zoom 16.
    static constexpr double growing_px = 5 / (11.390625 - 1); // 1.5^6
    static constexpr double constant_px = 1 - growing_px;
};

/// Returns the width of a road of medium rank, px.
double road_width_px(double zoom);

/// Returns the width of the casing on each side of a line, px.
double road_casing_px(double width_px);

/// Returns the denominator of the scale that a zoom has at the equator.
///
/// \param px_mm  size of a pixel
double denominator_of_zoom(double zoom, double px_mm = RoadWidths::px_mm);

/// Returns the zoom of a map on which a pixel is so large.
double zoom_of_metres_per_px(double metres_per_px);

} // namespace macadam
