#pragma once

#include "mapping/passes/chunk_trace.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace macadam {

inline constexpr int reach_m = 10; ///< lags of this size at most
static_assert(reach_m == trace_margin_m);
inline constexpr std::size_t lag_count = 2 * reach_m + 1;

/// Agreement at each whole lag, from -reach_m on.
using Correlation = std::array<std::int32_t, lag_count>;

inline constexpr std::size_t state_count = 2 * lag_count - 1; ///< lags of half metres

/// A logarithm of likelihood for each state, and some more that fill up six times eight. In parts
/// of a nat below the highest, in short whole numbers, so that eight are compared at once.
using States = std::array<std::int16_t, 48>;
static_assert(std::tuple_size_v<States> >= state_count);

/// What is known of lags before the traces are looked at.
struct LagPrior {
    std::array<float, state_count> nats; ///< each block's share of the logarithm of their prior
    double step_m2; ///< variance of the lag's change from one block to the next
};

/// A t distribution about 0.
///
/// \param sd_m    of the place along the road. > 0.
/// \param blocks  of the drive, which share it. >= 1.
LagPrior prior_of(double sd_m, double dof, double step_m2, std::size_t blocks);

/// For each block the lag, in whole centimetres, of the most likely course of lags along the chunk
/// that goes through it, within +-reach_m: the highest sum of scale * correlation and logarithm of
/// the prior, by dynamic programming over lags of half metres, and by parabolas between them.
/// Nothing if a lag comes out at the border: agreement still rises there, so the lag is another.
///
std::optional<std::vector<std::int32_t>>
best_lags_cm(std::span<const Correlation> sums, double scale, const LagPrior& prior);

} // namespace macadam
