#pragma once

#include "render/text/font_source.hpp"

#include <cstdint>
#include <filesystem>
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

/// A glyph of a line that has been set, from the left end of its base line.
struct SetGlyph {
    int font = 0;            ///< of the setter's
    std::uint32_t index = 0; ///< in the font
    double x_px = 0;
    double y_px = 0; ///< upwards
};

/// A letter with its marks, or letters that are one glyph: what turns as one where a line bends.
struct SetCluster {
    std::size_t first = 0, count = 0; ///< of the glyphs
    double left_px = 0, right_px = 0;
};

struct SetLine {
    std::vector<SetGlyph> glyphs;
    std::vector<SetCluster> clusters; ///< from left to right
    double width_px = 0;
    bool whole = true; ///< false: no font has some of its characters, which are left out
};

/// Where a glyph goes on a picture, x to the right and y downwards.
struct GlyphPose {
    double x_px = 0, y_px = 0;       ///< of its origin on the base line
    double along_x = 1, along_y = 0; ///< direction of the base line, of length 1
    friend bool operator==(const GlyphPose&, const GlyphPose&) = default;
};

/// Sets lines of text in any script of the fonts on the shelf (render/text/font_set.hpp): glyphs
/// are chosen and placed by HarfBuzz and drawn by FreeType, lines that mix directions are ordered
/// by FriBidi. Bytes that are not UTF-8 become replacement characters; what no font has is left
/// out.
///
/// Source: Unicode Standard Annex 9, "Unicode Bidirectional Algorithm", revision 46 (2022), rule L2
/// for the order of runs.
class TypeSetter {
public:
    /// \throws InputError  if DejaVu Sans is not installed. So do the other functions for the font
    ///                     of a script that a text needs.
    TypeSetter();
    explicit TypeSetter(const std::filesystem::path& fonts);
    ~TypeSetter();

    SetLine set(std::string_view utf8, const TextLook& look);

    double width_px(std::string_view utf8, const TextLook& look);
    TextMask mask(std::string_view utf8, const TextLook& look);

    /// Its characters in the order in which they stand, from left to right: the other way round
    /// where they are read from right to left.
    static std::string as_it_stands(std::string_view utf8);

    /// Where a SetGlyph's font is read from.
    FontSource source(int font) const;

    /// One glyph at its place on the picture; left and top of the mask count from the picture's
    /// corner. Level glyphs are fitted to the rows of pixels, turned ones are not.
    TextMask stamp(const SetGlyph& glyph, const TextLook& look, const GlyphPose& pose);

    /// Words broken into lines of at most `room_px`; a word that is wider itself is broken
    /// anywhere.
    std::vector<std::string> wrapped(std::string_view utf8, const TextLook& look, double room_px);

private:
    struct ShapingCache;
    std::unique_ptr<ShapingCache> desk_;
};

/// Several masks as one; where they overlap the denser counts.
TextMask merged(const std::vector<TextMask>& masks);

} // namespace macadam
