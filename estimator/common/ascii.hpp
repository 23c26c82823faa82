#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace macadam {

/// Returns the text with the letters A to Z as a to z; other bytes are kept.
inline std::string in_lower_case(std::string_view text) {
    std::string lower{text};
    std::ranges::transform(lower, lower.begin(), [](char c) {
        return 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return lower;
}

} // namespace macadam
