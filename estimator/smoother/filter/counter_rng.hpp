#pragma once

#include <cstdint>

namespace macadam {

/// Returns a standard normal number determined by the four arguments, independent of earlier draws,
/// so that a road smoothed in pieces gets the same numbers.
double
counter_normal(std::uint64_t seed, std::uint64_t what, std::uint64_t where, std::uint64_t which);

} // namespace macadam
