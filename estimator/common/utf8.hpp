#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace macadam {

/// Returns the number of bytes of the UTF-8 sequence at the front of `text`, or 0 if it has none
/// (RFC 3629).
inline std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
    };
    const auto follows = [&](std::size_t i, unsigned low, unsigned high) {
        return low <= byte(i) && byte(i) <= high;
    };
    const auto first = byte(0);
    if (first < 0x80) {
        return 1;
    }
    if (0xC2 <= first && first <= 0xDF) {
        return follows(1, 0x80, 0xBF) ? 2 : 0;
    }
    if (0xE0 <= first && first <= 0xEF) {
        const unsigned low = first == 0xE0 ? 0xA0 : 0x80;
        const unsigned high = first == 0xED ? 0x9F : 0xBF; // no surrogates
        return follows(1, low, high) && follows(2, 0x80, 0xBF) ? 3 : 0;
    }
    if (0xF0 <= first && first <= 0xF4) {
        const unsigned low = first == 0xF0 ? 0x90 : 0x80;
        const unsigned high = first == 0xF4 ? 0x8F : 0xBF;
        return follows(1, low, high) && follows(2, 0x80, 0xBF) && follows(3, 0x80, 0xBF) ? 4 : 0;
    }
    return 0;
}

/// Returns the code point of one UTF-8 sequence; for a single byte, valid or not, its value.
inline std::uint32_t utf8_letter(std::string_view sequence) {
    constexpr std::uint32_t first_bits[] = {0xFF, 0x1F, 0x0F, 0x07};
    std::uint32_t letter =
        static_cast<unsigned char>(sequence.front()) & first_bits[sequence.size() - 1];
    for (const char byte : sequence.substr(1)) {
        letter = letter << 6U | (static_cast<unsigned char>(byte) & 0x3FU);
    }
    return letter;
}

/// Tests for letters that turn the direction of the text after them: the embeddings, overrides and
/// isolates of the Unicode Bidirectional Algorithm (UAX 9, 2.1 to 2.5).
inline bool is_bidi_control(std::uint32_t letter) {
    return (0x202A <= letter && letter <= 0x202E) || (0x2066 <= letter && letter <= 0x2069);
}

} // namespace macadam
