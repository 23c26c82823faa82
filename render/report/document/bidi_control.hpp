#pragma once

#include "estimator/common/utf8.hpp"

#include <string_view>

namespace macadam {

/// Whether a letter turns the direction of the text that follows it, beyond its own name: U+202A to
/// U+202E and U+2066 to U+2069.
///
/// \param letter  one UTF-8 sequence
inline bool is_bidi_control(std::string_view letter) {
    const auto code = utf8_letter(letter);
    return (0x202A <= code && code <= 0x202E) || (0x2066 <= code && code <= 0x2069);
}

} // namespace macadam
