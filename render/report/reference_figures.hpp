#pragma once

#include "mapping/survey_score.hpp"

#include <span>
#include <string>

namespace macadam {

// Figures of the comparison with references as inline SVG.

/// The cars' IRI over the reference's, with the line on which both are alike. Pieces that would
/// stand on one another are one dot. \param pairs  at least one.
std::string scatter_svg(std::span<const SurveyPair> pairs);

/// How often the cars' IRI differs from the reference's by how much, in the bands of the paper's
/// figure and above, each with the normal curve of its mean and standard deviation.
std::string differences_svg(std::span<const SurveyPair> pairs);

} // namespace macadam
