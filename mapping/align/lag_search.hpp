#pragma once

#include "mapping/strip_trace.hpp"

#include <array>
#include <span>
#include <vector>

namespace macadam {

inline constexpr int reach_m = 10; ///< lags of this size at most
static_assert(reach_m == trace_margin_m);
inline constexpr std::size_t lag_count = 2 * reach_m + 1;

/// Agreement at each whole lag, from -reach_m on.
using Correlation = std::array<float, lag_count>;

/// What is known of lags before the traces are looked at.
struct LagPrior {
    double place_sd_m; ///< of the lag itself, under a t distribution ...
    double dof;        ///< ... with so many degrees of freedom
    double step_m2;    ///< variance of its change from one block to the next
};

/// For each block the lag of the most likely course of lags along the strip that goes through it,
/// within +-reach_m: the highest sum of scale * correlation and logarithm of the prior, by dynamic
/// programming over lags of half metres, and by parabolas between them.
std::vector<double>
best_lags(std::span<const Correlation> sums, double scale, const LagPrior& prior);

} // namespace macadam
