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

} // namespace macadam::testing
