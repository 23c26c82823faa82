#pragma once

#include "mapping/surveys/survey_row.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace macadam {

struct SurveyMatchConfig {
    double max_distance_m = 8; ///< the paper's d; receivers are good to four metres, there are two
    double max_angle_deg = 30; ///< the paper's phi, between the ways of both cars
    double sample_m = 2;       ///< of the trip, between positions
    double average_m = 100;    ///< of the trip: errors of positions along the road change in it
    double longest_hole_m = 100; ///< between positions, or without a match, that a pass may have
};

/// Where a trip was at a travel distance.
struct TripPlaceAt {
    GeoPoint at;
    double travel_m; ///< rising from place to place
};

/// The trip went over the piece of one row.
struct SurveyPass {
    std::size_t row;  ///< of the survey
    std::size_t pass; ///< 1 the first time, 2 the second, ...
    double from_m;    ///< travel
    double to_m;
    double distance_m; ///< mean, of the trip from the survey's line
};

/// Holds a trip beside a survey, as the paper does: a position of the trip belongs to the nearest
/// place of the survey's line that is within a distance and is driven in the same direction within
/// an angle. Neighbouring rows are joined by straight lines unless they are far apart; a row
/// without neighbours has no direction and is never met.
///
/// A sequence of such positions on which line and trip go on alike is a pass; how far the two
/// rulers are apart is averaged along it, so that errors of single positions do not move the
/// borders of pieces. A piece that is passed in part only is left out.
///
/// \returns  in the order of travel.
///
/// Source: section IV-A of the paper ("GNSS Matching").
std::vector<SurveyPass> match_survey(std::span<const SurveyRow> survey,
                                     std::span<const TripPlaceAt> trip,
                                     const SurveyMatchConfig& config);

} // namespace macadam
