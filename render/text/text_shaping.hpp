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

/// Rendered line of text: the coverage of each pixel by ink. Its origin is the left end of the
/// baseline.
struct TextMask {
    int left = 0, top = 0; ///< offset of the mask from the origin; top is negative
    int width = 0, height = 0;
    std::vector<std::uint8_t> coverage;
    std::string text{}; ///< content and look, for targets that set text themselves
    TextLook look{};
};

/// Glyph of a typeset line, relative to the left end of the baseline.
struct SetGlyph {
    int font = 0;            ///< font number of the setter
    std::uint32_t index = 0; ///< in the font
    double x_px = 0;
    double y_px = 0; ///< upwards
};

/// Letter with its marks, or ligature: the unit that is rotated on a curved line.
struct SetCluster {
    std::size_t first = 0, count = 0; ///< of the glyphs
    double left_px = 0, right_px = 0;
};

struct SetLine {
    std::vector<SetGlyph> glyphs;
    std::vector<SetCluster> clusters; ///< from left to right
    double width_px = 0;
    bool whole = true; ///< false: characters missing from all fonts are omitted
};

/// Position of a glyph on a picture, x to the right and y downwards.
struct GlyphPose {
    double x_px = 0, y_px = 0;       ///< of its origin on the baseline
    double along_x = 1, along_y = 0; ///< direction of the baseline, of length 1
    friend bool operator==(const GlyphPose&, const GlyphPose&) = default;
};

/// Typesets lines of text in any script of the font set (render/text/font_set.hpp): HarfBuzz
/// selects and positions glyphs, FreeType renders them, and FriBidi orders lines with mixed
/// directions. Bytes that are not UTF-8 become replacement characters; characters missing from all
/// fonts are omitted.
///
/// Source: Unicode Standard Annex 9, "Unicode Bidirectional Algorithm", revision 46 (2022), rule L2
/// for the order of runs.
class TypeSetter {
public:
    /// \throws InputError  if Noto Sans is not installed. The other functions throw it for the
    ///                     font of a script that a text needs.
    TypeSetter();
    explicit TypeSetter(const std::filesystem::path& fonts);
    ~TypeSetter();
    TypeSetter(TypeSetter&&) noexcept;
    TypeSetter& operator=(TypeSetter&&) noexcept;

    SetLine set(std::string_view utf8, const TextLook& look);

    double width_px(std::string_view utf8, const TextLook& look);
    TextMask mask(std::string_view utf8, const TextLook& look);

    /// Returns the characters in visual order from left to right: reversed for right-to-left text.
    static std::string as_it_stands(std::string_view utf8);

    /// Returns the source of a SetGlyph's font.
    FontSource source(int font) const;

    /// Renders one glyph at its position on the picture; left and top of the mask are relative to
    /// the picture's corner. Horizontal glyphs are hinted to pixel rows, rotated ones are not.
    TextMask stamp(const SetGlyph& glyph, const TextLook& look, const GlyphPose& pose);

    /// Wraps words into lines of at most `room_px`; a word that is wider is broken anywhere.
    std::vector<std::string> wrapped(std::string_view utf8, const TextLook& look, double room_px);

private:
    struct ShapingCache;
    std::unique_ptr<ShapingCache> desk_;
};

/// Merges several masks; where they overlap, the higher coverage counts.
TextMask merged(const std::vector<TextMask>& masks);

} // namespace macadam
