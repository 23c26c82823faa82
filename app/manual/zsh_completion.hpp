#pragma once

#include <string>

namespace macadam {

/// Returns the completion of all commands for zsh, the file _macadam.
std::string zsh_completion();

} // namespace macadam
