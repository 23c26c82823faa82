#pragma once

#include <string>

namespace macadam {

/// Returns the completion of all commands for fish, the file macadam.fish.
std::string fish_completion();

} // namespace macadam
