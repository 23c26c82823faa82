#include "render/report/document/pdf_blocks.hpp"

#include <algorithm>

namespace macadam {

using namespace document;

namespace {

constexpr double pt_per_unit = 0.72; // letters of 12 units match those of tables
constexpr double letters_units = 11;

struct Origin {
    double x_pt;
    double y_pt;
    double scale; ///< points of a unit
    double x(double units) const { return x_pt + units * scale; }
    double y(double units) const { return y_pt + units * scale; }
};

void set_colour(cairo_t* cairo, std::uint32_t rgb, double opacity) {
    const auto part = [rgb](unsigned shift) { return (rgb >> shift & 0xFFU) / 255.0; };
    cairo_set_source_rgba(cairo, part(16), part(8), part(0), opacity);
}

void draw(const PdfSheets& sheets, const Origin& origin, const Stroke& stroke) {
    auto* const cairo = sheets.cairo();
    const bool mean = stroke.look == StrokeLook::mean;
    set_colour(cairo, stroke.look == StrokeLook::grid ? print::border : print::ink, 1);
    cairo_set_line_width(cairo, stroke.look == StrokeLook::grid ? 0.4 : 0.8);
    const double dash_pt = 2;
    cairo_set_dash(cairo, &dash_pt, mean ? 1 : 0, 0);
    for (const auto& [x, y] : stroke.points) {
        cairo_line_to(cairo, origin.x(x), origin.y(y));
    }
    cairo_stroke(cairo);
    cairo_set_dash(cairo, nullptr, 0, 0);
}

void draw(const PdfSheets& sheets, const Origin& origin, const Bar& bar) {
    const double width_pt = bar.width * origin.scale;
    const double height_pt = bar.height * origin.scale;
    sheets.fill(bar.rgb, origin.x(bar.x), origin.y(bar.y), width_pt, height_pt);
    if (bar.edged) {
        sheets.frame(print::edge, origin.x(bar.x), origin.y(bar.y), width_pt, height_pt);
    }
}

void draw(const PdfSheets& sheets, const Origin& origin, const Band& band) {
    constexpr double opacity = 0.22; // as on a page on screen
    set_colour(sheets.cairo(), print::ink, opacity);
    cairo_rectangle(sheets.cairo(),
                    origin.x(band.x),
                    origin.y(band.y),
                    band.width * origin.scale,
                    band.height * origin.scale);
    cairo_fill(sheets.cairo());
}

void draw(PdfSheets& sheets, const Origin& origin, const Label& label) {
    const auto text =
        sheets.text(label.text, {.size_pt = letters_units * origin.scale, .rgb = print::quiet}, -1);
    const double base_pt = pango_units_to_double(pango_layout_get_baseline(text.layout()));
    const double before_pt = label.anchor == Anchor::start    ? 0
                             : label.anchor == Anchor::middle ? text.width_pt() / 2
                                                              : text.width_pt();
    sheets.draw(text, origin.x(label.x) - before_pt, origin.y(label.y) - base_pt);
}

void draw(const PdfSheets& sheets, const Origin& origin, const Dots& dots) {
    auto* const cairo = sheets.cairo();
    set_colour(cairo, dots.rgb, 0.6);
    cairo_set_line_width(cairo, dots.width * origin.scale);
    cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
    for (const auto& [x, y] : dots.places) {
        cairo_move_to(cairo, origin.x(x), origin.y(y));
        cairo_close_path(cairo);
    }
    cairo_stroke(cairo);
    cairo_set_line_cap(cairo, CAIRO_LINE_CAP_BUTT);
}

} // namespace

void draw_at(PdfSheets& sheets, const Drawing& drawing, double x_pt, double y_pt, double width_pt) {
    const PdfFigure figure{sheets, drawing.words};
    const Origin origin{x_pt, y_pt, width_pt / drawing.width};
    for (const auto& shape : drawing.shapes) {
        std::visit([&](const auto& of) { draw(sheets, origin, of); }, shape);
    }
}

void put(PdfSheets& sheets, const Drawing& drawing) {
    const double width_pt = std::min(sheets.width_pt(), drawing.width * pt_per_unit);
    const double height_pt = drawing.height * width_pt / drawing.width;
    sheets.need(std::min(height_pt, sheets.height_pt()));
    draw_at(sheets, drawing, sheets.left_pt(), sheets.y_pt(), width_pt);
    sheets.skip(height_pt + block_gap_pt);
}

} // namespace macadam
