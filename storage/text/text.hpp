#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// `text` without blanks and tabs at its ends.
std::string_view trimmed(std::string_view text);

/// `text` in quotes as messages show it: at most `longest` bytes, those that are not printable
/// ASCII as \x00, "..." where it is cut.
std::string in_quotes(std::string_view text, std::size_t longest = 40);

/// The number that the whole of `text` is, blanks around it and a leading '+' allowed; NaN for
/// "nan". Nothing if it is something else, or does not fit a double.
std::optional<double> parse_number(std::string_view text);

} // namespace macadam
