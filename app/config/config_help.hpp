#pragma once

#include <string>

namespace macadam {

/// Returns the output of `macadam help config`: where defaults of options come from, which options
/// may have one, and the values in force. An error in them is part of the text.
std::string config_help();

} // namespace macadam
