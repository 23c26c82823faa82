#pragma once

#include "mapping/strip_trace.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// A trace as agreement sees it: compressed, without its level, mean 0 and variance 1, 0 where
/// nothing is known; all 0 if there is nothing but level.
struct Signal {
    std::int32_t first_m;
    std::vector<float> x;
    std::vector<float> known; ///< 1 or 0
};

Signal signal_of(const StripTrace& trace);

/// How many metres of a signal tell as much as one independent value, by its autocorrelation; 1 or
/// more.
///
/// Source: M. S. Bartlett, "On the theoretical specification and sampling properties of
/// autocorrelated time-series", Supplement to the Journal of the Royal Statistical Society 8
/// (1946), pp. 27-41.
double independent_m(const std::vector<float>& x);

} // namespace macadam
