#pragma once

#include <vector>

namespace macadam {

/// Mean over a window of so many values, nearly a Gaussian's: three boxes in turn.
std::vector<double> windowed(std::vector<double> values, double window);

} // namespace macadam
