#pragma once

#include "mapping/passes/chunk_trace.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// A trace as agreement sees it: compressed, without its level, mean 0, 0 where nothing is known;
/// all 0 if there is nothing but level. Whole numbers in parts of its standard deviation, so that
/// sums of products are the same on every machine and in any order; short ones, so that eight are
/// multiplied at once.
struct Signal {
    std::int32_t first_m;
    std::vector<std::int16_t> x;     ///< signal_unit is one standard deviation
    std::vector<std::int16_t> known; ///< -1 (all bits) where x is known, else 0
};

inline constexpr int signal_unit = 256;
inline constexpr int max_signal = 8 * signal_unit; ///< what is more counts as this

Signal signal_of(const RoughnessTrace& trace);

/// Sum of the products of two rows of signals of one length.
std::int64_t dot(std::span<const std::int16_t> a, std::span<const std::int16_t> b);

/// How many metres of a signal tell as much as one independent value, by its autocorrelation; 1 or
/// more.
///
/// Source: M. S. Bartlett, "On the theoretical specification and sampling properties of
/// autocorrelated time-series", Supplement to the Journal of the Royal Statistical Society 8
/// (1946), pp. 27-41.
double independent_m(const std::vector<std::int16_t>& x);

} // namespace macadam
