#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace macadam {

/// A piece of road that a survey and a trip both know, mm/m.
struct SurveyPair {
    double survey;
    double trip;
    double low; ///< of the trip's 90 % interval; NaN: not known
    double high;
};

/// How near a trip came to a survey, over pieces that count alike; mm/m. NaN where there are too
/// few pieces to say it.
struct SurveyScore {
    double from_mm_per_m = 0; ///< of the survey's IRI, from and ...
    double to_mm_per_m = std::numeric_limits<double>::infinity(); ///< ... below
    std::size_t pieces = 0;
    double mean_survey = 0;
    double mean_trip = 0;
    double bias = 0; ///< mean of trip minus survey
    double sd = 0;   ///< of trip minus survey
    double rmse = 0;
    double correlation = 0;
    double coverage = 0; ///< share of the survey's values in the trip's interval
};

SurveyScore score_of(std::span<const SurveyPair> pairs);

/// From each edge up to below the next; those without pieces are left out.
///
/// \param edges_mm_per_m  of the survey's IRI, rising.
std::vector<SurveyScore> scores_by_level(std::span<const SurveyPair> pairs,
                                         std::span<const double> edges_mm_per_m);

/// In the bands of the paper's table III, 0, 2, 4, 6 and 12 mm/m, and above; those without pieces
/// are left out.
std::vector<SurveyScore> scores_by_band(std::span<const SurveyPair> pairs);

} // namespace macadam
