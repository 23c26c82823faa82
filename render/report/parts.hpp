#pragma once

#include "render/report/report.hpp"

#include <cstddef>
#include <string>
#include <string_view>

namespace macadam {

// What several sections of the report share. All give HTML.

/// "living_street" as "Living street".
std::string sentence_case(std::string_view name);

/// "1 car", "12 cars".
std::string count_text(std::size_t count, std::string_view one, std::string_view many);

/// HTML that stays on one line.
std::string unbroken(const std::string& html);

/// Text in which words that are longer than a column may break, and no others.
std::string breakable(std::string_view text);

/// The picture for the page's look. \param alt  HTML.
std::string picture_html(const ReportPicture& picture, const std::string& alt);

/// Cars, each once, however many models and methods it was read with.
std::size_t cars_in(const std::vector<ReportVehicle>& vehicles);

/// The sum of their numbers, without a name.
ReportVehicle total_of(const std::vector<ReportVehicle>& vehicles);

} // namespace macadam
