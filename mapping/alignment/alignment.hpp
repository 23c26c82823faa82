#pragma once

#include "mapping/passes/chunk_trace.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// Outcome of aligning one drive with the others.
enum class LagStatus : std::uint8_t {
    alone,        ///< agrees with no other drive, or is the only one: left unshifted
    found,        ///< shifted to the lag of best agreement
    beyond_reach, ///< agreement still rises at 10 m, so the true lag is unknown: left unshifted
};

/// Lag of a drive along its chunk: its reading at station s + lag belongs to station s. Given in
/// whole centimetres at the centres of 50 m blocks, interpolated linearly between them and held
/// constant beyond the first and last.
struct LagLine {
    std::int32_t first_block = 0;     ///< centred at block_m * (first_block + 1/2)
    std::vector<std::int32_t> lag_cm; ///< empty: no lag
    LagStatus finding = LagStatus::alone;
    friend bool operator==(const LagLine&, const LagLine&) = default;
};

inline constexpr double lag_block_m = 50;

double lag_m(const LagLine& line, double station_m);

/// Summary of the alignment of drives over chunks.
struct AlignmentSummary {
    std::int64_t drives = 0;
    std::int64_t found = 0;
    std::int64_t beyond_reach = 0;
    std::int64_t moved_far = 0;     ///< drives found with a lag above far_lag_m
    std::int32_t middle_lag_cm = 0; ///< median absolute lag of those found, or 0
};

inline constexpr double far_lag_m = 2;

/// Summarises lag lines. The lag of a drive is the mean of its line.
AlignmentSummary summary_of(std::span<const LagLine> lines);

struct AlignmentConfig {
    double drift_m2_per_m = 0.005; ///< random-walk variance of a drive's lag per metre of road
    double prior_dof = 4;          ///< of the t distribution of lags about their prior
    int rounds = 2;
};

/// Aligns the drives over one chunk by their roughness, since all of them read the same road
/// profile.
///
/// Each trace is compressed and freed of its level, so that a constant factor between cars or
/// speeds does no harm, and is correlated with the mean of the other traces. The chosen lag
/// maximises the posterior: it balances agreement against the drive's own position standard
/// deviation and against quick changes along the road (dynamic programming over lags of +-10 m). A
/// trace that agrees with no other, as on a smooth road, stays unshifted and influences no other;
/// so does a trace whose lag would lie at the +-10 m limit. An error common to all drives is
/// unobservable: the lags of each block, weighted by 1 / position sd^2, have mean 0.
///
/// Linear in the number of traces. Results are identical on any machine: correlations are integer
/// sums, and the rest consists of sums, products, quotients and square roots in a fixed order, none
/// contracted. The order of traces affects the last centimetre, so callers pass them in the order
/// of (trip hash, drive).
///
/// \returns  one line per trace.
std::vector<LagLine> lags_of(std::span<const RoughnessTrace> traces, const AlignmentConfig& config);

} // namespace macadam
