#pragma once

#include "mapping/surveys/survey_score.hpp"
#include "render/report/document/document.hpp"
#include "render/report/words/localised_text.hpp"

#include <span>
#include <string>

namespace macadam {

// Figures of the comparison with references, in the language and unit of `say`.

/// Draws the cars' IRI over the reference's, with the line of equality. Coinciding dots are merged.
/// \param pairs  at least one.
document::Drawing scatter_drawing(std::span<const SurveyPair> pairs, const Localisation& say);

/// Draws histograms of the differences between the cars' IRI and the reference's, in the bands of
/// the paper's figure and above, each with the normal curve of its mean and standard deviation.
document::Drawing differences_drawing(std::span<const SurveyPair> pairs, const Localisation& say);

/// Returns the range of reference values of a score: "1 – 2".
std::string level_text(const Localisation& say, const SurveyScore& score);

} // namespace macadam
