#pragma once

#include "render/report/document/document.hpp"
#include "render/report/report.hpp"

namespace macadam {

// Figures of the report, in the colours of the classes.

/// The classes of a road beside each other, as wide as they are long. Nothing covered: empty.
document::Cell share_bar(const Report& report, const RoadSummary& roads);

/// Kilometres of road by roughness, with the mean.
document::Drawing histogram_drawing(const Report& report);

} // namespace macadam
