#pragma once

#include "mapping/analysis/length_weighted_mean.hpp"
#include "mapping/fusion/segment_record.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace macadam {

/// How the errors of readings of one road hang together from place to place.
struct ErrorAlongRoad {
    double common_share = common_share_along_road; ///< of the variance: one error all along
    double correlation_m = 20; ///< the correlation of the rest falls to 1/e over this distance: 16
                               ///< m in the simulated fleet of docs/decisions/07
};

/// A piece of a measured segment on the ruler of a road that is followed.
struct MeasuredPiece {
    double length_m;           ///< of the piece
    double at_m;               ///< of the middle of the whole segment
    const SegmentState* state; ///< not null
};

/// What measured segments say together.
struct CorrelatedMean {
    RoadMean mean; ///< all zero where nothing is measured
    double worst_iri = 0;
    std::int32_t min_passes = 0;
    double median_passes = 0;  ///< over the pieces
    std::int32_t vehicles = 0; ///< the most that one segment has seen
    std::optional<std::int64_t> first_seen_ms;
    std::optional<std::int64_t> last_seen_ms;
};

/// The mean weighted by length, with an interval for errors that hang together: with w the weights
/// and x the places, the variance of the mean is
/// c (sum w sd)^2 + (1 - c) sum_ij w_i sd_i w_j sd_j exp(-|x_i - x_j| / L).
/// The common part, of the cars and of their model, never averages out; the rest does so over
/// distances much longer than L, not from one segment to the next.
///
/// \param pieces  in the order of at_m. O(n).
CorrelatedMean measured_road(std::span<const MeasuredPiece> pieces, const ErrorAlongRoad& errors);

} // namespace macadam
