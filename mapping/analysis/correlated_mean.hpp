#pragma once

#include "mapping/analysis/length_weighted_mean.hpp"
#include "mapping/fusion/segment_record.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace macadam {

/// Correlation of reading errors along a road.
struct ErrorAlongRoad {
    double common_share = common_share_along_road; ///< of the variance, for the entire road
    double correlation_m = 20; ///< distance over which the correlation of the rest falls to 1/e: 16
                               ///< m in the simulated fleet of docs/decisions/07
};

/// An interval of a measured segment on a linear route.
struct MeasuredPiece {
    double length_m;           ///< of the interval
    double at_m;               ///< route measure of the midpoint of the whole segment
    const SegmentState* state; ///< not null
};

/// Combined roughness of measured segments.
struct CorrelatedMean {
    RoadMean mean; ///< all zero if no segment is measured
    double worst_iri = 0;
    std::int32_t min_passes = 0;
    double median_passes = 0;  ///< over the intervals
    std::int32_t vehicles = 0; ///< maximum over the segments
    std::optional<std::int64_t> first_seen_ms;
    std::optional<std::int64_t> last_seen_ms;
};

/// Computes the length-weighted mean with an interval for correlated errors. With weights w and
/// measures x, the variance of the mean is
///   c (sum w sd)^2 + (1 - c) sum_ij w_i sd_i w_j sd_j exp(-|x_i - x_j| / L).
/// The common part, due to the cars and their model, never averages out; the rest does over
/// distances much longer than L, not from one segment to the next.
///
/// \param pieces  in the order of at_m. O(n).
CorrelatedMean measured_road(std::span<const MeasuredPiece> pieces, const ErrorAlongRoad& errors);

} // namespace macadam
