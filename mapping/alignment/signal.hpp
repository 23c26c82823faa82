#pragma once

#include "mapping/passes/chunk_trace.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// A trace prepared for correlation: compressed, level removed, mean 0, and 0 where unknown; all 0
/// if only the level carries information. Integer fractions of its standard deviation, so that sums
/// of products are identical on every machine and in any order; 16 bits wide, so that eight are
/// multiplied at once.
struct Signal {
    std::int32_t first_m;
    std::vector<std::int16_t> x;     ///< in units of 1/signal_unit standard deviations
    std::vector<std::int16_t> known; ///< -1 (all bits set) where x is known, else 0
};

inline constexpr int signal_unit = 256;
inline constexpr int max_signal = 8 * signal_unit; ///< larger values are clipped

Signal signal_of(const RoughnessTrace& trace);

/// Returns the dot product of two signals of equal length.
std::int64_t dot(std::span<const std::int16_t> a, std::span<const std::int16_t> b);

/// Returns the length in metres per independent value of a signal, from its autocorrelation; >= 1.
///
/// Source: M. S. Bartlett, "On the theoretical specification and sampling properties of
/// autocorrelated time-series", Supplement to the Journal of the Royal Statistical Society 8
/// (1946), pp. 27-41.
double independent_m(const std::vector<std::int16_t>& x);

} // namespace macadam
