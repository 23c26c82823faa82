#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Splits a line into cells and strips blanks and quotes around them. Separators within quotes are
/// text, and a doubled quote stands for a single quote.
std::vector<std::string> cells_of_line(std::string_view line, char separator);

/// Tests whether the whole of `text` matches a pattern in which '*' stands for any characters,
/// including none. The case of ASCII letters is ignored.
bool fits(std::string_view text, std::string_view pattern);

/// Text matched by the '*' of a pattern; "" if the pattern has none.
///
/// \param text  must match the pattern.
std::string star_of(std::string_view text, std::string_view pattern);

} // namespace macadam
