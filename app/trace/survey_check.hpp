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

/// What survey and trip say of one piece of road, each time that the trip came over it.
struct AgainstRow {
    SurveyRow survey;
    SurveyPass pass;
    double t_s; ///< at the middle
    IriMean mean;

    /// The survey's IRI of the kind that the trip's headline is, or the nearest to it that the
    /// survey has; and which.
    std::optional<double> survey_mm_per_m;
    std::string_view survey_index; ///< "MRI", "HRI", or "IRI" if the survey does not tell
};

struct Against {
    std::vector<AgainstRow> rows; ///< in the order of travel
    std::size_t survey_rows;
    std::size_t met; ///< of them, at least once
};

/// \throws InputError  if the trip meets nothing of the survey.
Against against_survey(std::span<const SurveyRow> survey,
                       const TripLog& trip,
                       const TripTrace& trace,
                       const Vehicle& vehicle,
                       const SurveyMatchConfig& config);

/// Results: CSV, or one JSON object of rows, score and scores by band.
std::string against_csv(const Against& against);
std::string against_json(const Against& against);

} // namespace macadam
