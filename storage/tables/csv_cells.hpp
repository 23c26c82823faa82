#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// The cells of a line, blanks around them and quotes taken off; a separator within quotes
/// separates nothing, and a doubled quote is one.
std::vector<std::string> cells_of_line(std::string_view line, char separator);

/// Whether the whole of `text` fits a pattern in which '*' stands for any letters, also none. Case
/// of ASCII letters does not count.
bool fits(std::string_view text, std::string_view pattern);

/// What the '*' of a pattern stands for in a text that fits it; "" if there is none.
std::string star_of(std::string_view text, std::string_view pattern);

} // namespace macadam
