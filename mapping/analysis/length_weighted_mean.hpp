#pragma once

#include "mapping/fusion/measured_segment.hpp"
#include "mapping/fusion/segment_record.hpp"

#include <span>
#include <vector>

namespace macadam {

/// An interval of road with its roughness and standard deviation, mm/m.
struct RatedLength {
    double length_m;
    double iri;
    double sd;
};

/// Extracts length and roughness of a segment that has passes.
RatedLength rated_length(const SegmentRecord& record);
RatedLength rated_length(const MeasuredSegment& segment);

/// Mean roughness of several intervals, mm/m.
struct RoadMean {
    double length_m = 0;
    double iri = 0; ///< length-weighted mean
    double sd = 0;
    double low = 0; ///< 90 % interval, not below 0
    double high = 0;
};

/// Share of the variance common to neighbouring segments: half, as between cars on one segment
/// (FusionConfig::common_share). Cars and model stay the same along a road; differences from one 20
/// m segment to the next average out.
inline constexpr double common_share_along_road = 0.5;

/// Computes the length-weighted mean. With weights w its variance is
///   share (sum w sd)^2 + (1 - share) sum (w sd)^2: the common part never averages out.
///
/// \param pieces        may be empty: all zero.
/// \param common_share  0 (independent) to 1 (one error for all).
RoadMean road_mean(std::span<const RatedLength> pieces,
                   double common_share = common_share_along_road);

/// Returns the roughness that `share` of the length does not exceed.
///
/// \param pieces  at least one. \param share  0 < share <= 1.
double road_percentile(std::vector<RatedLength> pieces, double share);

} // namespace macadam
