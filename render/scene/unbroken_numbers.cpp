#include "render/scene/unbroken_numbers.hpp"

#include <algorithm>
#include <array>

namespace macadam {
namespace {

constexpr std::string_view no_break = "\u00A0";
constexpr std::string_view dash = "–";

constexpr bool is_digit(char c) {
    return '0' <= c && c <= '9';
}

/// Returns true for letters, and for bytes of letters beyond ASCII.
constexpr bool is_letter(char c) {
    return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') ||
           static_cast<unsigned char>(c) >= 0x80;
}

/// Inches alone are missing: "in" is a word too.
bool begins_with_unit(std::string_view text) {
    constexpr std::array<std::string_view, 8> units{
        "%", "km", "m", "mm", "mm/m", "ft", "mi", "in/mi"};
    return std::ranges::any_of(units, [&](std::string_view unit) {
        return text.starts_with(unit) &&
               (text.size() == unit.size() || !is_letter(text[unit.size()]));
    });
}

/// Returns true for the rest of an interval from its dash on.
bool begins_with_upper_end(std::string_view text) {
    return text.size() > dash.size() + 1 && text.starts_with(dash) && text[dash.size()] == ' ' &&
           is_digit(text[dash.size() + 1]);
}

} // namespace

std::size_t slashed_unit_at_start(std::string_view text) {
    for (const std::string_view unit : {"mm/m", "in/mi"}) {
        if (text.starts_with(unit) &&
            (text.size() == unit.size() || !is_letter(text[unit.size()]))) {
            return unit.size();
        }
    }
    return 0;
}

std::string with_unbroken_numbers(std::string_view text) {
    std::string unbroken;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool follows_number = text[i] == ' ' && i > 0 && is_digit(text[i - 1]);
        const auto rest = text.substr(i + 1);
        if (follows_number && begins_with_upper_end(rest)) {
            unbroken.append(no_break).append(dash); // a line may end after the dash
            i += dash.size();
        } else if (follows_number && begins_with_unit(rest)) {
            unbroken += no_break;
        } else {
            unbroken += text[i];
        }
    }
    return unbroken;
}

} // namespace macadam
