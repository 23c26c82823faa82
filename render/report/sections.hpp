#pragma once

#include "render/report/report.hpp"

#include <string>

namespace macadam {

// Parts of the page, as HTML. Those of condition and worst stretches need something measured.
std::string head_section(const Report& report); ///< title, period, numbers that count
std::string condition_section(const Report& report);
std::string map_section(const Report& report);
std::string worst_section(const Report& report);
std::string own_sections(const Report& report); ///< "" where none are asked for
std::string coverage_section(const Report& report);
std::string data_section(const Report& report);
std::string method_section(const Report& report); ///< how it was measured, how to read it, limits
std::string source_section(const Report& report); ///< whose map it is

} // namespace macadam
