#pragma once

#include <string>
#include <string_view>

namespace macadam {

/// Escapes text for a terminal. Control characters, marks that change the writing direction and
/// bytes that are not UTF-8 are spelled out ("\x1b", "\u202e"). Line ends stay.
std::string printable(std::string_view text);

/// Escapes a name within a line; line ends are spelled out, too.
std::string printable_name(std::string_view name);

} // namespace macadam
