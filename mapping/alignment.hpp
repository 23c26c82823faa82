#pragma once

#include "mapping/strip_trace.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// How far a drive's own places lie from the common ones, along the strip: what it read at station
/// s + lag belongs to s. In whole centimetres at the middles of blocks of 50 m, straight between
/// them, held beyond.
struct LagLine {
    std::int32_t first_block = 0;     ///< whose middle is at block_m * (first_block + 1/2)
    std::vector<std::int32_t> lag_cm; ///< empty: no lag
    friend bool operator==(const LagLine&, const LagLine&) = default;
};

inline constexpr double lag_block_m = 50;

double lag_m(const LagLine& line, double station_m);

struct AlignmentConfig {
    double drift_m2_per_m = 0.005; ///< how the lag of one drive changes along the road
    double prior_dof = 4;          ///< of the t distribution of lags about their prior
    int rounds = 2;
};

/// Lays the drives over one strip on each other by what they read: the road's texture is the same
/// for all of them.
///
/// Each trace is compressed and freed of its level, so that cars and speeds differ by a factor
/// without harm, and held against the mean of the others where these lie so far. The lag of highest
/// posterior is taken: agreement, against the drive's own standard deviation of place and against
/// quick changes along the road (dynamic programming over lags of +-10 m). A trace that agrees with
/// no other, as on a smooth road, stays where it was and moves nobody. What all have in common
/// cannot be seen: each block's lags, weighted by 1 / place sd^2, have the mean 0.
///
/// Linear in the number of traces. The same for any machine; the order of traces matters in the
/// last centimetre, so a caller gives them in the order of (trip hash, drive).
///
/// \returns  as many as traces.
std::vector<LagLine> lags_of(std::span<const StripTrace> traces, const AlignmentConfig& config);

} // namespace macadam
