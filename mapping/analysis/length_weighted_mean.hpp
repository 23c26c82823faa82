#pragma once

#include "mapping/fusion/segment_record.hpp"

#include <span>
#include <vector>

namespace macadam {

/// A piece of road with what is known of its roughness, mm/m.
struct RatedLength {
    double length_m;
    double iri;
    double sd;
};

/// Of a segment with passes.
RatedLength rated_length(const SegmentRecord& record);

/// Roughness of many pieces together, mm/m.
struct RoadMean {
    double length_m = 0;
    double iri = 0; ///< weighted by length
    double sd = 0;
    double low = 0; ///< 90 % interval, not below 0
    double high = 0;
};

/// What is common to the readings of neighbouring segments: half of the variance, as between cars
/// on one segment (FusionConfig::common_share). The cars and the model are the same all along a
/// road; what differs from one 20 m to the next averages out.
inline constexpr double common_share_along_road = 0.5;

/// The mean weighted by length. With w the weights, its variance is
/// share (sum w sd)^2 + (1 - share) sum (w sd)^2: the common part never averages out.
///
/// \param pieces        may be none: all zero.
/// \param common_share  0 (independent) to 1 (one error for all).
RoadMean road_mean(std::span<const RatedLength> pieces,
                   double common_share = common_share_along_road);

/// The roughness that `share` of the length does not exceed.
/// \param pieces  at least one. \param share  0 < share <= 1.
double road_percentile(std::vector<RatedLength> pieces, double share);

} // namespace macadam
