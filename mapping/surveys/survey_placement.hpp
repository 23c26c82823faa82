#pragma once

#include "mapping/network/segment.hpp"
#include "mapping/surveys/reference_survey.hpp"

#include <cstddef>
#include <string_view>
#include <vector>

namespace macadam {

/// Overlap of a row with one segment.
struct ReferencePart {
    std::size_t row;
    SegmentKey segment;
    double segment_m; ///< length of the segment
    double row_m;     ///< length of the row
    double from_m;    ///< along the way from its first node, from_m < to_m
    double to_m;
    double confidence; ///< 0..1 of the match; 1 if the row names its way
};

/// Location of rows on a network.
struct LocatedReference {
    std::vector<ReferencePart> parts;       ///< in the order of the rows
    std::vector<std::string_view> unplaced; ///< per row: why it has no part; "" if it has one
};

/// Locates the rows of a survey. Rows by way are cut at segment boundaries. Consecutive rows by
/// coordinates are joined to lines, and each line is matched to the roads like a trip (map_match);
/// its driving direction determines the direction of the segments. Rows with a heading or with both
/// ends may be listed with or against the order of travel; midpoints without a heading are taken as
/// driven in file order.
///
/// Reasons: no_place, no_such_way, beyond_way (past its end), not_drivable (against a oneway),
/// off_network (no road drivable in that direction).
LocatedReference placed_on(const RoadNetwork& roads, const ReferenceSurvey& survey);

} // namespace macadam
