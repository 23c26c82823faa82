#pragma once

#include "mapping/analysis/length_weighted_mean.hpp"
#include "mapping/fusion/segment_record.hpp"
#include "mapping/network/road_network.hpp"
#include "mapping/style/iri_class.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace macadam {

struct WorstSectionConfig {
    double above_mm_per_m = 2.683; ///< what is poor; see poor_above
    double min_length_m = 100;     ///< shorter ones are left out
    double max_unmeasured_m = 30;  ///< without a pass, in a row, within a stretch: one segment,
                                   ///< which is 20 m long give or take the share of its link
    double most_better_m = 50;     ///< not poor, in a row, within a stretch: about two segments
    double sharpest_turn_deg = 60; ///< where a road goes on in another way
    double common_share = common_share_along_road;
};

/// Where a stretch lies on one way: from_m < to_m along it from its first node, whatever the
/// driving direction.
struct StretchPart {
    std::int64_t way_id;
    bool forward;
    double from_m;
    double to_m;
};

/// Poor road in one piece, in driving direction.
struct WorstSection {
    std::string name;
    std::string highway;
    std::vector<StretchPart> parts; ///< as driven, at least one
    std::vector<GeoPoint> line;
    std::vector<std::size_t> records; ///< its measured segments: places in what was given
    double length_m;                  ///< with what is unmeasured within
    RoadMean mean;                    ///< of the measured segments
    double worst_iri;                 ///< of one segment, mm/m
    std::int32_t min_passes;
    double median_passes;
    std::int32_t vehicles; ///< the most that one segment has seen
    std::optional<std::int64_t> first_seen_ms;
    std::optional<std::int64_t> last_seen_ms;
    GeoPoint middle;
};

/// Above what roughness (mm/m) a road is poor by a class table: the upper border of its middle
/// class. `fhwa`: 2.68 mm/m = 170 in/mi; `five`: 3.5 mm/m.
double poor_above(const ClassTable& table);

/// Neighbouring poor segments as stretches, the worst (by mean) first; stretches of the same mean
/// in the order of their first segments.
///
/// A road is followed in driving direction from segment to segment: along its way, and into another
/// way where that has the same name (or neither has one and both are of one class) and goes on
/// without a sharp turn; of several the straightest. A stretch is a run of its segments such that
/// whatever beginning or end of it one looks at has a mean above the border: it begins and ends
/// with poor segments, and grows while its mean stays poor. Single better segments within are
/// bridged, as roughness scatters from one 20 m to the next; longer better road and roads that
/// nobody drove end it.
///
/// \param roads     the network that the segments are of.
/// \param measured  segments with a state; others are passed over. Any order.
///
/// Source of the runs: W. L. Ruzzo and M. Tompa, "A linear time algorithm for finding all maximal
/// scoring subsequences", ISMB 1999, pp. 234-241; the score of a segment is its length times what
/// it exceeds the border by.
std::vector<WorstSection> worst_sections(const RoadNetwork& roads,
                                         std::span<const SegmentRecord> measured,
                                         const WorstSectionConfig& config);

} // namespace macadam
