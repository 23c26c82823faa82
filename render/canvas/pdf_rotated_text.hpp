#pragma once

#include "render/canvas/pdf_page.hpp"

#include <cairo.h>

#include <map>
#include <memory>

namespace macadam {

/// Font faces by source.
class PdfFonts {
public:
    cairo_font_face_t* face(const FontSource& font);

private:
    struct Release {
        void operator()(cairo_font_face_t* face) const { cairo_font_face_destroy(face); }
    };
    std::map<FontSource, std::unique_ptr<cairo_font_face_t, Release>> faces_;
};

/// Draws the text of PdfPage::write_turned.
void draw_turned(cairo_t* cairo, PdfFonts& fonts, const TurnedText& text);

} // namespace macadam
