#pragma once

#include "mapping/analysis/length_weighted_mean.hpp"
#include "mapping/fusion/measured_segment.hpp"
#include "mapping/fusion/segment_record.hpp"
#include "mapping/network/road_network.hpp"
#include "mapping/style/iri_class.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

struct WorstSectionConfig {
    double above_mm_per_m = 2.683; ///< threshold of poor roughness; see poor_above
    double min_length_m = 100;     ///< shorter sections are omitted
    double max_unmeasured_m = 30;  ///< longest gap without a pass within a section: one segment,
                                   ///< which is 20 m long, more or less by rounding within its link
    double most_better_m = 50; ///< longest gap of better road within a section: about two segments
    double sharpest_turn_deg = 60; ///< largest turn at which a road continues in another way
    double common_share = common_share_along_road;
};

/// Interval of a section on one way: from_m < to_m, measured from the way's first node in either
/// driving direction.
struct StretchPart {
    std::int64_t way_id;
    bool forward;
    double from_m;
    double to_m;
};

/// A contiguous section of poor road, in driving direction.
struct WorstSection {
    std::string name;
    std::string highway;
    std::vector<StretchPart> parts; ///< in driving order, at least one
    std::vector<GeoPoint> line;
    std::vector<std::size_t> records; ///< its measured segments, as indices into the input
    double length_m;                  ///< including unmeasured road within
    RoadMean mean;                    ///< of the measured segments
    double worst_iri;                 ///< of a single segment, mm/m
    std::int32_t min_passes;
    double median_passes;
    std::int32_t vehicles; ///< maximum over the segments
    std::optional<std::int64_t> first_seen_ms;
    std::optional<std::int64_t> last_seen_ms;
    GeoPoint middle;
};

/// Returns the roughness (mm/m) above which a road is poor by a class table: the upper bound of its
/// middle class. `fhwa`: 2.68 mm/m = 170 in/mi; `five`: 3.5 mm/m.
double poor_above(const ClassTable& table);

/// Joins neighbouring poor segments to sections, the worst mean first; sections of equal mean are
/// in the order of their first segments.
///
/// A road is followed in driving direction: along its way, and into another way of the same name
/// (or of the same class if neither has a name) that continues without a sharp turn; the
/// straightest if there are several. A section is a run of segments in which every prefix and every
/// suffix has a mean above the threshold: it begins and ends with poor segments and grows while its
/// mean stays poor. Single better segments are bridged, because roughness scatters from one 20 m to
/// the next; longer stretches of better or unmeasured road end the section.
///
/// \param roads     the network of the segments.
/// \param measured  in any order.
///
/// Source of the runs: W. L. Ruzzo and M. Tompa, "A linear time algorithm for finding all maximal
/// scoring subsequences", ISMB 1999, pp. 234-241; the score of a segment is its length times its
/// excess over the threshold.
std::vector<WorstSection> worst_sections(const RoadNetwork& roads,
                                         std::span<const MeasuredSegment> measured,
                                         const WorstSectionConfig& config);

/// Joins the segments of records likewise; those without a state are skipped.
std::vector<WorstSection> worst_sections(const RoadNetwork& roads,
                                         std::span<const SegmentRecord> records,
                                         const WorstSectionConfig& config);

/// Weight of a road's traffic: a convention, by OSM's class of the road. Motorway to primary 4,
/// secondary 3, tertiary 2, service roads, tracks and unknown classes 1/2, all other roads 1. Slip
/// roads count with their road.
double traffic_weight(std::string_view highway);

/// Need of repair of a section, mm: its measured length times its roughness above the border of
/// poor, times the weight of its traffic.
struct RepairNeed {
    double certain;  ///< of the lower end of the 90 % interval, at least 0
    double expected; ///< of the mean
};

RepairNeed repair_need(const WorstSection& section, double above_mm_per_m);

/// Sorts sections by their certain need, those without any by their expected need, the greatest
/// first. A road that was passed once has a wide interval, and so hardly a certain need.
void sort_by_need(std::vector<WorstSection>& sections, double above_mm_per_m);

} // namespace macadam
