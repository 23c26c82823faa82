#pragma once

#include <string>
#include <string_view>

namespace macadam {

/// Text as a terminal may be given it, whatever names stand in it: bytes that steer a terminal,
/// marks that turn the direction of writing, and bytes that are no UTF-8 are spelled out ("\x1b",
/// "\u202e"). Ends of lines stay.
std::string printable(std::string_view text);

/// The same of a name within a line: ends of lines are spelled out, too.
std::string printable_name(std::string_view name);

} // namespace macadam
