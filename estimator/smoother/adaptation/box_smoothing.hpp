#pragma once

#include <vector>

namespace macadam {

/// Smooths values by three successive box filters, nearly a Gaussian window of this many values.
std::vector<double> windowed(std::vector<double> values, double window);

} // namespace macadam
