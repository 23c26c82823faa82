#pragma once

#include "render/text/font_set.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Part of a line that is shaped at once: one direction, one script, one font.
struct TextRun {
    std::size_t first = 0, count = 0; ///< of the line's characters
    std::uint32_t script = 0;         ///< ISO 15924's four letters as a number
    int font = -1;                    ///< -1: no font has these characters
    bool leftwards = false;           ///< right to left
};

/// Decodes UTF-8; invalid bytes become U+FFFD.
std::u32string characters_of(std::string_view utf8);

std::string utf8_of(std::u32string_view characters);

/// Returns the characters of a line from left to right in visual order.
std::u32string in_visual_order(std::u32string text);

/// Returns the runs of a line from left to right in visual order.
std::vector<TextRun> runs_of(std::u32string_view text, bool bold, FontSet& shelf);

} // namespace macadam
