#pragma once

#include "app/trace/survey_check.hpp"

namespace macadam {

/// Returns the pairs with both IRI values known, the trip's over the whole row: validity `ok` or
/// `indicative`.
std::vector<SurveyPair> compared_pairs(const Against& against);

/// Summarises coverage and agreement for people, in lines with newlines.
std::string against_summary(const Against& against);

/// Plots both along the trip, and one over the other, as an SVG file.
std::string against_svg(const Against& against);

} // namespace macadam
