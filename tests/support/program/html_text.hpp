#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace macadam::testing {

/// Returns the text between each `before` and the next `after`.
inline std::vector<std::string>
between(const std::string& text, std::string_view before, std::string_view after) {
    std::vector<std::string> found;
    for (auto at = text.find(before); at != std::string::npos; at = text.find(before, at)) {
        at += before.size();
        found.push_back(text.substr(at, text.find(after, at) - at));
    }
    return found;
}

/// Returns a text with plain spaces in place of no-break spaces.
inline std::string with_plain_spaces(std::string text) {
    constexpr std::string_view no_break = "\u00A0";
    for (auto at = text.find(no_break); at != std::string::npos; at = text.find(no_break, at)) {
        text.replace(at, no_break.size(), " ");
    }
    return text;
}

} // namespace macadam::testing
