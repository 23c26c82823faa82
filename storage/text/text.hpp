#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// Strips blanks and tabs from both ends of `text`.
std::string_view trimmed(std::string_view text);

/// Quotes `text` for messages: at most `longest` bytes, with "..." where it is cut. Bytes that are
/// neither printable ASCII nor letters in UTF-8 appear as \x00.
std::string in_quotes(std::string_view text, std::size_t longest = 40);

/// Parses the whole of `text` as a number; blanks around it and a leading '+' are allowed, and
/// "nan" is NaN. Returns `std::nullopt` for other text and for numbers that do not fit a double.
std::optional<double> parse_number(std::string_view text);

} // namespace macadam
