#pragma once

#include "render/report/report.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

// What several sections of the report share.

/// "living_street" as "Living street".
std::string sentence_case(std::string_view name);

/// A kind of road in the report's language; what the catalogue has no word for, as it came.
std::string kind_name(const Report& report, std::string_view kind);

/// Likewise a class of roughness.
std::string class_name(const Report& report, std::size_t i);

/// What values a class has, "1.50 – 2.68", in the style's words if it has any.
std::string class_range(const Report& report, const Localisation& wording, std::size_t i);

/// The legend's words for roads with few passes and for those without, as the style has them; in
/// the language of the report where the style says nothing of its own.
std::string few_passes_words(const Report& report);
std::string unmeasured_words(const Report& report);

/// The road's name, or what kind of road has none.
std::string road_name(const Report& report, const WorstSection& stretch);

/// Metres along its ways, as driven: they fall where a way is driven against.
std::string reference_text(const Report& report, const WorstSection& stretch);

/// "2", or "2 – 5": the least that a segment has, and the median.
std::string passes_text(const Localisation& wording, std::int32_t least, double median);

/// The map with a scale bar that is as wide as its length, whatever a page makes of the picture.
document::MapFigure map_figure(const Report& report,
                               const ReportPicture& picture,
                               double width_m,
                               const std::string& words);

/// Cars, each once, however many models and methods it was read with.
std::size_t cars_in(const std::vector<ReportVehicle>& vehicles);

/// The sum of their numbers, without a name.
ReportVehicle total_of(const std::vector<ReportVehicle>& vehicles);

} // namespace macadam
