#pragma once

#include "app/trace/survey_check.hpp"

namespace macadam {

/// Where both know the IRI, and the trip knows it of the whole piece: validity `ok` or
/// `indicative`.
std::vector<SurveyPair> compared_pairs(const Against& against);

/// For people: what was met and how well it agrees, lines with newlines.
std::string against_summary(const Against& against);

/// Both along the trip, and one over the other, as an SVG file.
std::string against_svg(const Against& against);

} // namespace macadam
