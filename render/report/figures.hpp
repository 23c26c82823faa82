#pragma once

#include "render/report/document/document.hpp"
#include "render/report/report.hpp"

namespace macadam {

// Figures of the report, in the colours of the classes.

/// Returns a bar of the classes of a road, with widths in proportion to their lengths. Empty if no
/// length is covered.
document::Cell share_bar(const Report& report, const RoadSummary& roads);

/// Draws kilometres of road by roughness, with the mean.
document::Drawing histogram_drawing(const Report& report);

} // namespace macadam
