#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace macadam {

/// An interval of road measured by both a survey and a trip, mm/m.
struct SurveyPair {
    double survey;
    double trip;
    double low; ///< of the trip's 90 % interval; NaN: unknown
    double high;
};

/// Agreement of a trip with a survey over equally weighted intervals; mm/m. NaN if there are too
/// few intervals.
struct SurveyScore {
    double from_mm_per_m = 0; ///< lower bound of the survey's IRI
    double to_mm_per_m = std::numeric_limits<double>::infinity(); ///< exclusive upper bound
    std::size_t pieces = 0;
    double mean_survey = 0;
    double mean_trip = 0;
    double bias = 0; ///< mean of trip minus survey
    double sd = 0;   ///< of trip minus survey
    double rmse = 0;
    double correlation = 0;
    double coverage = 0; ///< share of the survey's values within the trip's interval
};

SurveyScore score_of(std::span<const SurveyPair> pairs);

/// Scores the pairs of each level, from an edge to below the next; levels without intervals are
/// omitted.
///
/// \param edges_mm_per_m  of the survey's IRI, ascending.
std::vector<SurveyScore> scores_by_level(std::span<const SurveyPair> pairs,
                                         std::span<const double> edges_mm_per_m);

/// Scores the pairs in the bands of the paper's table III: 0, 2, 4, 6 and 12 mm/m, and above; empty
/// bands are omitted.
std::vector<SurveyScore> scores_by_band(std::span<const SurveyPair> pairs);

} // namespace macadam
