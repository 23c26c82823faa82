#pragma once

#include "mapping/style/base_map.hpp"
#include "render/canvas/draw_target.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// How a line begins and ends: round, or cut off at the point itself.
struct LineEnds {
    bool round_begin = true;
    bool round_end = true;
};

/// A glyph of a font, where it goes on a page.
struct PageGlyph {
    FontSource font;
    std::uint32_t index = 0; ///< in the font
    GlyphPose pose{};
};

/// A line of text whose letters have been set before, each in a direction of its own.
struct TurnedText {
    std::string standing; ///< what it says, UTF-8, from left to right as it stands
    double size_px = 0;   ///< of the em
    std::vector<PageGlyph> glyphs;
    std::uint32_t rgb = 0;
    double halo_px = 0; ///< how far the ground around letters is painted over
    std::uint32_t halo_rgb = 0;
};

/// A page of a PDF file. Shapes stay shapes, and text stays text, in fonts that the file carries:
/// DejaVu Sans, and for other scripts what the machine has.
class PdfPage : public DrawTarget {
public:
    /// A line through points, with round joins.
    virtual void draw(std::span<const PixelPoint> line,
                      double radius_px,
                      std::uint32_t rgb,
                      const LineEnds& ends) = 0;

    /// A line of text. \param at  left end of the base line
    virtual void write_text(const std::string& utf8,
                            const TextLook& look,
                            const PixelPoint& at,
                            std::uint32_t rgb) = 0;

    /// A line of text along a curve. Who searches or copies text finds it whole.
    virtual void write_turned(const TurnedText& text) = 0;

    /// A picture, one of its pixels to one of the page.
    ///
    /// \param rgba  opaque, top row first
    virtual void lay(const PicturePart& part, std::span<const std::uint8_t> rgba) = 0;

    virtual double width_px(const std::string& utf8, const TextLook& look) = 0;

    /// What is drawn from now on shows only inside the box; nothing else until end_clip().
    virtual void begin_clip(const PixelBox& box) = 0;
    virtual void end_clip() = 0;

    virtual void next_page() = 0;
};

/// Pages of one size.
struct PdfSheet {
    double width_px, height_px;
    double px_per_inch;
    std::string title;  ///< in the file's properties
    std::string author; ///< whose data
    std::string made;   ///< ISO 8601, UTC: the same pages make the same bytes; "" = 1970
};

/// The bytes of a PDF file of the pages that `draw` draws, one at least. The same on every machine
/// with the same fonts and the same versions of Cairo and Pango.
///
/// \throws InputError  if Cairo cannot write it.
std::string pdf_file(const PdfSheet& sheet, const std::function<void(PdfPage& page)>& draw);

/// What the plug-in macadam_pdf is asked for.
using PdfWrite = void(const PdfSheet& sheet,
                      const std::function<void(PdfPage& page)>& draw,
                      const std::function<void(std::string bytes)>& take);
inline constexpr const char* pdf_write_name = "macadam_pdf_write";

} // namespace macadam
