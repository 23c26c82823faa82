#include "storage/text/xml_escape.hpp"

#include "estimator/common/utf8.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace macadam {
namespace {

constexpr std::string_view replacement = "\xef\xbf\xbd"; // U+FFFD

/// Escapes one character. Characters that XML 1.0 (2.2) cannot represent are replaced: control
/// characters, U+FFFE and U+FFFF.
std::string escaped(std::string_view character) {
    const auto code = static_cast<unsigned char>(character.front());
    if (character == "&") {
        return "&amp;";
    }
    if (character == "<") {
        return "&lt;";
    }
    if (character == ">") {
        return "&gt;";
    }
    if (character == "\"") {
        return "&quot;";
    }
    if (character == "\r" || character == "\n" || character == "\t") {
        return fmt::format("&#{};", code); // readers would normalise them
    }
    const bool cannot_be_said =
        code < 0x20 || character == "\xef\xbf\xbe" || character == "\xef\xbf\xbf";
    return std::string{cannot_be_said ? replacement : character};
}

} // namespace

std::string xml_text(std::string_view text) {
    std::string made;
    while (!text.empty()) {
        const auto bytes = utf8_length(text);
        made += bytes == 0 ? std::string{replacement} : escaped(text.substr(0, bytes));
        text.remove_prefix(std::max<std::size_t>(bytes, 1));
    }
    return made;
}

} // namespace macadam
