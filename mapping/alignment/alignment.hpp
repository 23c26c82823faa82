#pragma once

#include "mapping/passes/chunk_trace.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// What came of laying a drive on the others.
enum class LagStatus : std::uint8_t {
    alone,        ///< it agrees with no other, or there is none: it stays where it was
    found,        ///< it lies where it agrees best
    beyond_reach, ///< agreement still rises 10 m off: the lag is another, and unknown. It stays
};

/// How far a drive's own places lie from the common ones, along the chunk: what it read at station
/// s + lag belongs to s. In whole centimetres at the middles of blocks of 50 m, straight between
/// them, held beyond.
struct LagLine {
    std::int32_t first_block = 0;     ///< whose middle is at block_m * (first_block + 1/2)
    std::vector<std::int32_t> lag_cm; ///< empty: no lag
    LagStatus finding = LagStatus::alone;
    friend bool operator==(const LagLine&, const LagLine&) = default;
};

inline constexpr double lag_block_m = 50;

double lag_m(const LagLine& line, double station_m);

/// What came of laying the drives over chunks on each other.
struct AlignmentSummary {
    std::int64_t drives = 0;
    std::int64_t found = 0;        ///< of them
    std::int64_t beyond_reach = 0; ///< of them
    std::int64_t moved_far = 0;    ///< of those found, by more than far_lag_m
    std::int32_t middle_lag_cm =
        0; ///< the median of those found, whichever way; 0 if there is none
};

inline constexpr double far_lag_m = 2;

/// A drive's lag is the mean of its line.
AlignmentSummary summary_of(std::span<const LagLine> lines);

struct AlignmentConfig {
    double drift_m2_per_m = 0.005; ///< how the lag of one drive changes along the road
    double prior_dof = 4;          ///< of the t distribution of lags about their prior
    int rounds = 2;
};

/// Lays the drives over one chunk on each other by what they read: the road's texture is the same
/// for all of them.
///
/// Each trace is compressed and freed of its level, so that cars and speeds differ by a factor
/// without harm, and held against the mean of the others where these lie so far. The lag of highest
/// posterior is taken: agreement, against the drive's own standard deviation of place and against
/// quick changes along the road (dynamic programming over lags of +-10 m). A trace that agrees with
/// no other, as on a smooth road, stays where it was and moves nobody; so does one whose lag would
/// lie at the border of +-10 m. What all have in common cannot be seen: each block's lags, weighted
/// by 1 / place sd^2, have the mean 0.
///
/// Linear in the number of traces. The same on any machine: correlations are sums of whole numbers,
/// the rest sums, products, quotients and square roots in a fixed order, none contracted. The order
/// of traces matters in the last centimetre, so a caller gives them in the order of (trip hash,
/// drive).
///
/// \returns  as many as traces.
std::vector<LagLine> lags_of(std::span<const RoughnessTrace> traces, const AlignmentConfig& config);

} // namespace macadam
