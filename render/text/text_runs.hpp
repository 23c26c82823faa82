#pragma once

#include "render/text/font_set.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// A part of a line that is set in one go: one direction, one script, one font.
struct TextRun {
    std::size_t first = 0, count = 0; ///< of the line's characters
    std::uint32_t script = 0;         ///< ISO 15924's four letters as a number
    int font = -1;                    ///< -1: no font has these characters
    bool leftwards = false;           ///< written from right to left
};

/// UTF-8 as characters; bytes that are none become U+FFFD.
std::u32string characters_of(std::string_view utf8);

std::string utf8_of(std::u32string_view characters);

/// The characters of a line from left to right as they stand on the picture.
std::u32string in_visual_order(std::u32string text);

/// The runs of a line from left to right as they stand on the picture.
std::vector<TextRun> runs_of(std::u32string_view text, bool bold, FontSet& shelf);

} // namespace macadam
