#pragma once

#include "mapping/surveys/survey_score.hpp"
#include "render/report/document/document.hpp"
#include "render/report/words/localised_text.hpp"

#include <span>
#include <string>

namespace macadam {

// Figures of the comparison with references, in the language and unit of `say`.

/// The cars' IRI over the reference's, with the line on which both are alike. Pieces that would
/// stand on one another are one dot. \param pairs  at least one.
document::Drawing scatter_drawing(std::span<const SurveyPair> pairs, const Localisation& say);

/// How often the cars' IRI differs from the reference's by how much, in the bands of the paper's
/// figure and above, each with the normal curve of its mean and standard deviation.
document::Drawing differences_drawing(std::span<const SurveyPair> pairs, const Localisation& say);

/// Between which values of the reference a score's pieces lie: "1 – 2".
std::string level_text(const Localisation& say, const SurveyScore& score);

} // namespace macadam
