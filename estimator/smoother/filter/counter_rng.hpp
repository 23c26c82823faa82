#pragma once

#include <cstdint>

namespace macadam {

/// A standard normal number that belongs to the four: always the same, whatever was drawn before,
/// so that a road that is smoothed in pieces meets the same numbers.
double
counter_normal(std::uint64_t seed, std::uint64_t what, std::uint64_t where, std::uint64_t which);

} // namespace macadam
