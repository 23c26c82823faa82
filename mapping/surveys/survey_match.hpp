#pragma once

#include "mapping/surveys/survey_row.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace macadam {

struct SurveyMatchConfig {
    double max_distance_m = 8;   ///< d in the paper: two receivers, each good to four metres
    double max_angle_deg = 30;   ///< phi in the paper, between the courses of both cars
    double sample_m = 2;         ///< sampling distance of the trip
    double average_m = 100;      ///< window for averaging position errors along the road
    double longest_hole_m = 100; ///< within a pass, between positions or without a match
};

/// Position of a trip at a travelled distance.
struct TravelPosition {
    GeoPoint at;
    double travel_m; ///< strictly increasing
};

/// Pass of a trip over the interval of one row.
struct SurveyPass {
    std::size_t row;  ///< of the survey
    std::size_t pass; ///< 1 for the first pass, 2 for the second, ...
    double from_m;    ///< travel
    double to_m;
    double distance_m; ///< mean distance of the trip from the survey's line
};

/// Matches a trip to a survey as in the paper: a position of the trip belongs to the nearest point
/// of the survey's line that lies within a distance and is driven in the same direction within an
/// angle. Neighbouring rows are joined by straight lines unless they are far apart; a row without
/// neighbours has no direction and is never matched.
///
/// A sequence of such positions on which line and trip advance alike is a pass. The offset between
/// the two measures is averaged along it, so that errors of single positions do not move the ends
/// of intervals. Intervals passed only in part are omitted.
///
/// \returns  in the order of travel.
///
/// Source: section IV-A of the paper ("GNSS Matching").
std::vector<SurveyPass> match_survey(std::span<const SurveyRow> survey,
                                     std::span<const TravelPosition> trip,
                                     const SurveyMatchConfig& config);

} // namespace macadam
