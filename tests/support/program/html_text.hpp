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

/// Replaces every occurrence of a piece of text.
inline void replace_all(std::string& text, std::string_view piece, std::string_view by) {
    for (auto at = text.find(piece); at != std::string::npos;
         at = text.find(piece, at + by.size())) {
        text.replace(at, piece.size(), by);
    }
}

/// Returns a text with plain spaces in place of no-break spaces, and without marks of units whose
/// lines do not break.
inline std::string with_plain_spaces(std::string text) {
    replace_all(text, "\u00A0", " ");
    for (const std::string unit : {"mm/m", "in/mi"}) {
        replace_all(text, "<span class=\"nw\">" + unit + "</span>", unit);
    }
    return text;
}

} // namespace macadam::testing
