#pragma once

#include <string_view>

namespace macadam {

/// Tests a text against a pattern of LIKE: % stands for any text, _ for one letter (a code point
/// of UTF-8), and a letter after \ for itself. Takes at most the product of their lengths.
bool is_like(std::string_view text, std::string_view pattern);

} // namespace macadam
