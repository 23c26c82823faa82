#pragma once

#include <string>

namespace macadam {

/// Returns the style sheet of a report, for narrow and wide, light and dark screens, and for paper.
std::string report_style();

} // namespace macadam
