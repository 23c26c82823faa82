#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

struct TextLook {
    double size_px = 0; ///< of the em
    bool bold = false;
};

/// A line of text as it will be blended: how much of each pixel is ink. Its origin is the left end
/// of the base line.
struct TextMask {
    int left = 0, top = 0; ///< of the mask, from the origin; top is negative
    int width = 0, height = 0;
    std::vector<std::uint8_t> coverage;
    std::string text{}; ///< what it says, and how, for pens that set text themselves
    TextLook look{};
};

/// Sets lines of text in DejaVu Sans, in any script it has: glyphs are chosen and placed by
/// HarfBuzz and drawn by FreeType. Bytes that are not UTF-8 become replacement characters.
///
/// A line that mixes left-to-right and right-to-left scripts is set in the direction of the first.
class TypeSetter {
public:
    /// \throws InputError  if the fonts are not installed.
    TypeSetter();
    ~TypeSetter();

    double width_px(std::string_view utf8, const TextLook& look);
    TextMask mask(std::string_view utf8, const TextLook& look);

    /// Words broken into lines of at most `room_px`; a word that is wider itself is broken
    /// anywhere.
    std::vector<std::string> wrapped(std::string_view utf8, const TextLook& look, double room_px);

private:
    struct Fonts;
    std::unique_ptr<Fonts> fonts_;
};

} // namespace macadam
