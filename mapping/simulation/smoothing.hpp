#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// Computes the moving mean over half_width values on both sides of each; the window shrinks
/// symmetrically near the ends, which therefore remain unchanged.
std::vector<double> boxed(std::span<const double> values, std::span<const std::size_t> half_width);
std::vector<double> boxed(std::span<const double> values, std::size_t half_width);

/// Generates slow noise, one value per step: standard deviation `sd`, correlation length `steps`.
std::vector<double> slow_noise(std::size_t count, double sd, double steps, std::uint64_t seed);

} // namespace macadam
