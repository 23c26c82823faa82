#pragma once

#include <string>

namespace macadam {

/// Returns the completion of all commands for bash; it needs no other script.
std::string bash_completion();

} // namespace macadam
