#include "app/cli/terminal_escape.hpp"

#include "estimator/common/utf8.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace macadam {
namespace {

/// Tests for the controls of the Unicode Bidirectional Algorithm (UAX 9, 2) and for line and
/// paragraph separators.
bool steers_writing(std::uint32_t letter) {
    return is_bidi_control(letter) || letter == 0x061C || letter == 0x200E || letter == 0x200F ||
           letter == 0x2028 || letter == 0x2029;
}

/// Tests for C0, DEL and C1 of ECMA-48.
bool steers_a_terminal(std::uint32_t letter) {
    return letter < 0x20 || (0x7F <= letter && letter <= 0x9F);
}

bool is_printable_ascii(char c) {
    return 0x20 <= c && c < 0x7F;
}

std::string spelled(std::string_view letter) {
    const auto code = utf8_letter(letter);
    if (letter.size() == 1 && (code < 0x20 || code >= 0x7F)) {
        return fmt::format("\\x{:02x}", code);
    }
    if (steers_a_terminal(code) || steers_writing(code)) {
        return fmt::format("\\u{:04x}", code);
    }
    return std::string{letter};
}

} // namespace

std::string printable_name(std::string_view name) {
    std::string text;
    text.reserve(name.size());
    while (!name.empty()) {
        // Every cell of a table comes here, and most are ASCII.
        const auto other = std::ranges::find_if_not(name, is_printable_ascii);
        text.append(name.begin(), other);
        name.remove_prefix(static_cast<std::size_t>(other - name.begin()));
        if (name.empty()) {
            break;
        }
        const auto length = std::max<std::size_t>(1, utf8_length(name));
        text += spelled(name.substr(0, length));
        name.remove_prefix(length);
    }
    return text;
}

std::string printable(std::string_view text) {
    std::string lines;
    lines.reserve(text.size());
    for (auto end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
        lines += printable_name(text.substr(0, end)) + "\n";
        text.remove_prefix(end + 1);
    }
    return lines + printable_name(text);
}

} // namespace macadam
