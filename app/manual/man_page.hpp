#pragma once

#include "app/cli/commands.hpp"

#include <string>
#include <string_view>

namespace macadam {

/// Returns macadam.1: the list of all commands, in the markup of man pages (groff, mandoc).
std::string man_page_of_all(std::string_view version);

/// Returns macadam-COMMAND.1: one command with all of its options.
std::string man_page_of(const Command& command, std::string_view version);

} // namespace macadam
