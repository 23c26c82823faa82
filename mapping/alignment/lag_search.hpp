#pragma once

#include "mapping/passes/chunk_trace.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace macadam {

inline constexpr int reach_m = 10; ///< largest lag considered
static_assert(reach_m == trace_margin_m);
inline constexpr std::size_t lag_count = 2 * reach_m + 1;

/// Agreement at each whole-metre lag, starting at -reach_m.
using Correlation = std::array<std::int32_t, lag_count>;

inline constexpr std::size_t state_count = 2 * lag_count - 1; ///< lags in steps of half a metre

/// Log-likelihood of each state, padded to six times eight. Values are fractions of a nat below the
/// maximum, in 16-bit integers, so that eight are compared at once.
using States = std::array<std::int16_t, 48>;
static_assert(std::tuple_size_v<States> >= state_count);

/// Prior of the lags.
struct LagPrior {
    std::array<float, state_count> nats; ///< each block's share of the log prior
    double step_m2; ///< variance of the change in lag from one block to the next
};

/// Builds the prior, a t distribution about 0.
///
/// \param sd_m    sd of the position along the road. > 0.
/// \param blocks  number of blocks of the drive, which share the prior. >= 1.
LagPrior prior_of(double sd_m, double dof, double step_m2, std::size_t blocks);

/// Returns each block's lag in whole centimetres on the most likely lag profile through that block,
/// within +-reach_m. Maximises the sum of scale * correlation and log prior by dynamic programming
/// over lags of half a metre, refined by parabolas.
///
/// \returns  `std::nullopt` if a lag lies at the limit: agreement still rises there, so the true
/// lag lies beyond.
std::optional<std::vector<std::int32_t>>
best_lags_cm(std::span<const Correlation> sums, double scale, const LagPrior& prior);

} // namespace macadam
