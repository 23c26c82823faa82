#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace macadam {

/// Returns a text whose lines do not break between a number and its unit or percent sign, nor
/// before the dash of an interval such as "1.87 – 2.43": these spaces become no-break spaces.
std::string with_unbroken_numbers(std::string_view text);

/// Returns the length in bytes of the unit with a slash that a text begins with, or 0: a line could
/// break after the slash of "in/mi".
std::size_t slashed_unit_at_start(std::string_view text);

} // namespace macadam
