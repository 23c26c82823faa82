#pragma once

#include "mapping/style/base_map.hpp"
#include "render/canvas/draw_target.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// Ends of a line: round, or cut off at the end point.
struct LineEnds {
    bool round_begin = true;
    bool round_end = true;
};

/// Glyph of a font, with its position on a page.
struct PageGlyph {
    FontSource font;
    std::uint32_t index = 0; ///< in the font
    GlyphPose pose{};
};

/// Line of text with typeset letters, each with a direction of its own.
struct TurnedText {
    std::string standing; ///< UTF-8 text, from left to right in visual order
    double size_px = 0;   ///< of the em
    std::vector<PageGlyph> glyphs;
    std::uint32_t rgb = 0;
    double halo_px = 0; ///< width of the halo painted around letters
    std::uint32_t halo_rgb = 0;
};

/// Page of a PDF file. Shapes remain vectors and text remains text, in embedded fonts: Noto Sans,
/// and for other scripts the fonts installed on the machine.
class PdfPage : public DrawTarget {
public:
    /// Draws a line through points, with round joins.
    virtual void draw(std::span<const PixelPoint> line,
                      double radius_px,
                      std::uint32_t rgb,
                      const LineEnds& ends) = 0;

    /// Fills what rings enclose, each closed by its first point; those that run against others
    /// around them are holes.
    virtual void fill_rings(std::span<const std::span<const PixelPoint>> rings,
                            std::uint32_t rgb) = 0;

    /// Writes a line of text. \param at  left end of the baseline
    virtual void write_text(const std::string& utf8,
                            const TextLook& look,
                            const PixelPoint& at,
                            std::uint32_t rgb) = 0;

    /// Writes a line of text along a curve. It remains complete for searching and copying.
    virtual void write_turned(const TurnedText& text) = 0;

    /// Draws a picture at one picture pixel per page pixel.
    ///
    /// \param rgba  opaque, top row first
    virtual void lay(const PicturePart& part, std::span<const std::uint8_t> rgba) = 0;

    /// Covers a box with a colour whose opacity grows from none at one position to all at another,
    /// by a cubic step, and remains so beyond.
    virtual void
    veil(const PixelBox& box, const PixelPoint& from, const PixelPoint& to, std::uint32_t rgb) = 0;

    virtual double width_px(const std::string& utf8, const TextLook& look) = 0;

    /// Clips the following drawing to the box, until end_clip().
    virtual void begin_clip(const PixelBox& box) = 0;

    /// Clips the following drawing to the box and measures it from the box's corner, until
    /// end_clip().
    virtual void begin_part(const PixelBox& box) = 0;
    virtual void end_clip() = 0;

    virtual void next_page() = 0;
};

/// Format and metadata of a PDF file.
struct PdfSheet {
    double width_px, height_px;
    double px_per_inch;
    std::string title;  ///< in the file's properties
    std::string author; ///< owner of the data
    std::string made;   ///< ISO 8601, UTC, fixed for reproducible bytes; "" = 1970
};

/// Returns the bytes of a PDF file with the pages that `draw` draws, at least one. They are
/// identical on every machine with the same fonts and the same versions of Cairo and Pango.
///
/// \throws InputError  if Cairo cannot write it.
std::string pdf_file(const PdfSheet& sheet, const std::function<void(PdfPage& page)>& draw);

/// Entry point of the plug-in macadam_pdf.
using PdfWrite = void(const PdfSheet& sheet,
                      const std::function<void(PdfPage& page)>& draw,
                      const std::function<void(std::string bytes)>& take);
inline constexpr const char* pdf_write_name = "macadam_pdf_write";

} // namespace macadam
