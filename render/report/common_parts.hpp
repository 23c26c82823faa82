#pragma once

#include "render/report/report.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

// Common helpers of the report's sections.

/// Converts "living_street" to "Living street".
std::string sentence_case(std::string_view name);

/// Returns a kind of road in the report's language; unchanged if the catalogue has no word for it.
std::string kind_name(const Report& report, std::string_view kind);

/// Returns the name of a roughness class in the report's language.
std::string class_name(const Report& report, std::size_t i);

/// Returns the values of a class, "1.50 – 2.68", in the style's own words if it has any.
std::string class_range(const Report& report, const Localisation& wording, std::size_t i);

/// Return the legend's words for roads with few passes and for roads without a measurement, from
/// the style, or by default in the language of the report.
std::string few_passes_words(const Report& report);
std::string unmeasured_words(const Report& report);

/// Returns the road's name for use in sentences, too, or its kind if it has no name.
std::string road_name(const Report& report, const WorstSection& stretch);

/// Returns the chainage along its ways, as driven: it decreases where a way is driven in reverse
/// direction.
std::string reference_text(const Report& report, const WorstSection& stretch);

/// Returns "2", or "2 – 5": minimum and median per segment.
std::string passes_text(const Localisation& wording, std::int32_t least, double median);

/// Builds a photo with its caption.
/// \param road  what it shows
document::Photo photo_of(const Report& report, const ReportPhoto& photo, const std::string& road);

/// Builds the map figure, with a scale bar that keeps its relative length at any size of the
/// picture.
document::MapFigure map_figure(const Report& report,
                               const ReportPicture& picture,
                               double width_m,
                               const std::string& words);

/// Returns the words of what a page offers beside its content.
/// \param contents  whether the page lists its sections
document::PageWords page_words(const Localisation& wording, bool contents);

/// Counts the distinct cars, regardless of the number of models and methods used.
std::size_t cars_in(const std::vector<ReportVehicle>& vehicles);

/// Returns the sum of their numbers, without a name.
ReportVehicle total_of(const std::vector<ReportVehicle>& vehicles);

} // namespace macadam
