#pragma once

#include "app/inspect/inspection.hpp"

#include <string>

namespace macadam {

/// Formats an inspection for people, without the mapping.
std::string inspection_text(const Inspection& found);

/// Formats an inspection as a JSON object.
std::string inspection_json(const Inspection& found);

} // namespace macadam
