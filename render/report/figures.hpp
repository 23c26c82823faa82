#pragma once

#include "render/report/document/document.hpp"
#include "render/report/report.hpp"

namespace macadam {

// Figures of the report, in the colours of the classes.

/// Returns a bar of the classes of a road, with widths in proportion to their lengths. Empty if no
/// length is covered.
document::Cell share_bar(const Report& report, const RoadSummary& roads);

/// Size of a histogram in its own units, of which a phone shows 400 on about 330 px.
struct HistogramSize {
    double width, height;
};
inline constexpr HistogramSize histogram_in_a_column{400, 230};
inline constexpr HistogramSize histogram_over_a_page{720, 205};

/// Draws kilometres of road by roughness, with the mean.
document::Drawing histogram_drawing(const Report& report, const HistogramSize& size);

} // namespace macadam
