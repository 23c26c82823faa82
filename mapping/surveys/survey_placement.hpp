#pragma once

#include "mapping/network/segment.hpp"
#include "mapping/surveys/reference_survey.hpp"

#include <cstddef>
#include <string_view>
#include <vector>

namespace macadam {

/// What of a row lies on one segment.
struct ReferencePart {
    std::size_t row;
    SegmentKey segment;
    double segment_m; ///< length of the segment
    double row_m;     ///< length of the row
    double from_m;    ///< along the way from its first node, from_m < to_m
    double to_m;
    double confidence; ///< 0..1 of the match; 1 where the row names its way
};

/// Where rows lie on a network.
struct PlacedReference {
    std::vector<ReferencePart> parts;       ///< in the order of the rows
    std::vector<std::string_view> unplaced; ///< per row: why it has no part; "" where it has one
};

/// Rows by ways are cut at the borders of segments. Rows by coordinates that follow each other are
/// joined to lines, and each line is matched to the roads as a trip is (map_match): the direction
/// in which it was driven decides the direction of the segments. Rows with a heading or with both
/// ends may stand in the file in the order of travel or against it; middles without a heading are
/// taken as driven in the file's order.
///
/// Reasons: no_place, no_such_way, beyond_way (past its end), not_drivable (against a oneway),
/// off_network (no road there that may be driven so).
PlacedReference placed_on(const RoadNetwork& roads, const ReferenceSurvey& survey);

} // namespace macadam
