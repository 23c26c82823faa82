#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// The mean over half_width values on both sides of each; over as many as there are on both, near
/// the ends, which so stay where they are.
std::vector<double> boxed(std::span<const double> values, std::span<const std::size_t> half_width);
std::vector<double> boxed(std::span<const double> values, std::size_t half_width);

/// A slow noise, one value a step: standard deviation `sd`, forgotten over `steps` of them.
std::vector<double> slow_noise(std::size_t count, double sd, double steps, std::uint64_t seed);

} // namespace macadam
