#pragma once

#include "app/pipeline/pipeline.hpp"
#include "app/pipeline/single_trip.hpp"
#include "mapping/surveys/survey_match.hpp"
#include "mapping/surveys/survey_score.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Survey row and one pass of the trip over it.
struct AgainstRow {
    SurveyRow survey;
    SurveyPass pass;
    double t_s; ///< at the middle
    IriMean mean;

    /// Survey IRI of the same kind as the trip's headline value, or of the nearest kind that the
    /// survey has; `survey_index` names the kind.
    std::optional<double> survey_mm_per_m;
    std::string_view survey_index; ///< "MRI", "HRI", or "IRI" if the survey does not say
};

struct Against {
    std::vector<AgainstRow> rows; ///< in the order of travel
    std::size_t survey_rows;
    std::size_t met; ///< survey rows covered at least once
};

/// Compares a trip with a survey.
/// \throws InputError  if the trip covers no row of the survey.
Against against_survey(std::span<const SurveyRow> survey,
                       const TripLog& trip,
                       const TripTrace& trace,
                       const Vehicle& vehicle,
                       const SurveyMatchConfig& config);

/// Formats results as CSV, or as one JSON object of rows, score and scores by band.
std::string against_csv(const Against& against);
std::string against_json(const Against& against);

} // namespace macadam
