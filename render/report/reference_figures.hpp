#pragma once

#include "mapping/survey_score.hpp"
#include "render/report/document.hpp"
#include "render/report/wording.hpp"

#include <span>
#include <string>

namespace macadam {

// Figures of the comparison with references, in the language and unit of `say`.

/// The cars' IRI over the reference's, with the line on which both are alike. Pieces that would
/// stand on one another are one dot. \param pairs  at least one.
document::Drawing scatter_drawing(std::span<const SurveyPair> pairs, const Wording& say);

/// How often the cars' IRI differs from the reference's by how much, in the bands of the paper's
/// figure and above, each with the normal curve of its mean and standard deviation.
document::Drawing differences_drawing(std::span<const SurveyPair> pairs, const Wording& say);

/// Between which values of the reference a score's pieces lie: "1 – 2".
std::string level_text(const Wording& say, const SurveyScore& score);

} // namespace macadam
