#include "render/canvas/pdf_page.hpp"

#include "estimator/common/error.hpp"
#include "render/canvas/pdf_rotated_text.hpp"
#include "render/text/pdf_families.hpp"

#include <cairo-pdf.h>
#include <fmt/core.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <numbers>

namespace macadam {
namespace {

constexpr double pt_per_inch = 72;

struct Release {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
    void operator()(cairo_pattern_t* pattern) const { cairo_pattern_destroy(pattern); }
    void operator()(PangoLayout* layout) const { g_object_unref(layout); }
    void operator()(PangoFontDescription* font) const { pango_font_description_free(font); }
    void operator()(cairo_font_options_t* options) const { cairo_font_options_destroy(options); }
};

template <typename Thing>
using Owned = std::unique_ptr<Thing, Release>;

cairo_status_t append(void* to, const unsigned char* data, unsigned length) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), // NOLINT(*-cast)
                                          length);
    return CAIRO_STATUS_SUCCESS;
}

void expect(cairo_status_t status) {
    if (status != CAIRO_STATUS_SUCCESS) {
        throw InputError{fmt::format("the PDF cannot be made: {}", cairo_status_to_string(status))};
    }
}

/// Copies pixels to Cairo's format: blue, green, red and an unused byte in native byte order.
void put_pixels(cairo_surface_t* picture, std::span<const std::uint8_t> rgba) {
    cairo_surface_flush(picture);
    const auto width = std::size_t(cairo_image_surface_get_width(picture));
    const auto height = std::size_t(cairo_image_surface_get_height(picture));
    const auto stride = std::size_t(cairo_image_surface_get_stride(picture));
    auto* const data = cairo_image_surface_get_data(picture);
    for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            const auto* const from = rgba.data() + (y * width + x) * 4;
            const auto pixel = std::uint32_t{from[0]} << 16 | std::uint32_t{from[1]} << 8 | from[2];
            std::memcpy(data + y * stride + x * 4, &pixel, sizeof(pixel));
        }
    }
    cairo_surface_mark_dirty(picture);
}

class CairoPage final : public PdfPage {
public:
    CairoPage(cairo_surface_t* surface, double pt_per_px) : cairo_{cairo_create(surface)} {
        cairo_scale(cairo_.get(), pt_per_px, pt_per_px);
        cairo_set_line_join(cairo_.get(), CAIRO_LINE_JOIN_ROUND);
        layout_.reset(pango_cairo_create_layout(cairo_.get()));
        // Letters keep their exact positions instead of being hinted to a screen's pixels.
        const Owned<cairo_font_options_t> options{cairo_font_options_create()};
        cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
        cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
        auto* const context = pango_layout_get_context(layout_.get());
        pango_cairo_context_set_font_options(context, options.get());
        pango_context_set_round_glyph_positions(context, FALSE);
        pango_layout_set_single_paragraph_mode(layout_.get(), TRUE);
    }

    void fill(const RoundedBox& shape, std::uint32_t rgb) override {
        trace(shape);
        colour(rgb);
        cairo_fill(cairo_.get());
    }

    void stroke(const PixelPoint& from,
                const PixelPoint& to,
                double radius_px,
                std::uint32_t rgb) override {
        const PixelPoint line[]{from, to};
        draw(line, radius_px, rgb, {});
    }

    void fill_triangle(const PixelPoint& a,
                       const PixelPoint& b,
                       const PixelPoint& c,
                       std::uint32_t rgb) override {
        const PixelPoint corners[]{a, b, c};
        follow(corners);
        cairo_close_path(cairo_.get());
        colour(rgb);
        cairo_fill(cairo_.get());
    }

    void write(const TextMask& text, const PixelPoint& at, std::uint32_t rgb) override {
        write_text(text.text, text.look, at, rgb);
    }

    void draw(std::span<const PixelPoint> line,
              double radius_px,
              std::uint32_t rgb,
              const LineEnds& ends) override {
        const bool round = ends.round_begin && ends.round_end;
        follow(line);
        colour(rgb);
        cairo_set_line_width(cairo_.get(), 2 * radius_px);
        cairo_set_line_cap(cairo_.get(), round ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
        cairo_stroke(cairo_.get());
        if (!round && ends.round_begin) {
            dot(line.front(), radius_px);
        }
        if (!round && ends.round_end) {
            dot(line.back(), radius_px);
        }
    }

    void write_text(const std::string& utf8,
                    const TextLook& look,
                    const PixelPoint& at,
                    std::uint32_t rgb) override {
        set(utf8, look);
        colour(rgb);
        cairo_move_to(cairo_.get(), at.x, at.y);
        pango_cairo_show_layout_line(cairo_.get(),
                                     pango_layout_get_line_readonly(layout_.get(), 0));
    }

    void write_turned(const TurnedText& text) override { draw_turned(cairo_.get(), fonts_, text); }

    void fill_rings(std::span<const std::span<const PixelPoint>> rings,
                    std::uint32_t rgb) override {
        cairo_new_path(cairo_.get());
        for (const auto& ring : rings) {
            cairo_new_sub_path(cairo_.get());
            for (const auto& point : ring) {
                cairo_line_to(cairo_.get(), point.x, point.y);
            }
            cairo_close_path(cairo_.get());
        }
        colour(rgb);
        cairo_fill(cairo_.get());
    }

    void lay(const PicturePart& part, std::span<const std::uint8_t> rgba) override {
        const Owned<cairo_surface_t> picture{
            cairo_image_surface_create(CAIRO_FORMAT_RGB24, part.width_px, part.height_px)};
        expect(cairo_surface_status(picture.get()));
        put_pixels(picture.get(), rgba);
        cairo_save(cairo_.get());
        cairo_set_source_surface(cairo_.get(), picture.get(), part.left_px, part.top_px);
        cairo_rectangle(cairo_.get(), part.left_px, part.top_px, part.width_px, part.height_px);
        cairo_fill(cairo_.get());
        cairo_restore(cairo_.get());
    }

    void veil(const PixelBox& box,
              const PixelPoint& from,
              const PixelPoint& to,
              std::uint32_t rgb) override {
        constexpr int steps = 8; // straight pieces that look like the cubic
        const auto channel = [&](unsigned shift) { return (rgb >> shift & 255U) / 255.0; };
        const Owned<cairo_pattern_t> pattern{
            cairo_pattern_create_linear(from.x, from.y, to.x, to.y)};
        for (int i = 0; i <= steps; ++i) {
            const double t = double(i) / steps;
            cairo_pattern_add_color_stop_rgba(
                pattern.get(), t, channel(16), channel(8), channel(0), t * t * (3 - 2 * t));
        }
        trace({box});
        cairo_set_source(cairo_.get(), pattern.get());
        cairo_fill(cairo_.get());
    }

    double width_px(const std::string& utf8, const TextLook& look) override {
        set(utf8, look);
        int width = 0;
        pango_layout_get_size(layout_.get(), &width, nullptr);
        return double(width) / PANGO_SCALE;
    }

    void begin_clip(const PixelBox& box) override {
        cairo_save(cairo_.get());
        cairo_rectangle(cairo_.get(), box.left, box.top, box.width(), box.height());
        cairo_clip(cairo_.get());
    }

    void begin_part(const PixelBox& box) override {
        begin_clip(box);
        cairo_translate(cairo_.get(), box.left, box.top);
    }

    void end_clip() override { cairo_restore(cairo_.get()); }

    void next_page() override { cairo_show_page(cairo_.get()); }

    void expect_well() const { expect(cairo_status(cairo_.get())); }

private:
    void colour(std::uint32_t rgb) {
        const auto channel = [&](unsigned shift) { return (rgb >> shift & 255U) / 255.0; };
        cairo_set_source_rgb(cairo_.get(), channel(16), channel(8), channel(0));
    }

    void dot(const PixelPoint& at, double radius_px) {
        cairo_new_path(cairo_.get());
        cairo_arc(cairo_.get(), at.x, at.y, radius_px, 0, 2 * std::numbers::pi);
        cairo_fill(cairo_.get());
    }

    void follow(std::span<const PixelPoint> points) {
        cairo_new_path(cairo_.get());
        for (const auto& point : points) {
            cairo_line_to(cairo_.get(), point.x, point.y);
        }
    }

    void trace(const RoundedBox& shape) {
        const auto& box = shape.box;
        const double r = std::clamp(shape.radius_px, 0.0, std::min(box.width(), box.height()) / 2);
        cairo_new_path(cairo_.get());
        if (r == 0) {
            cairo_rectangle(cairo_.get(), box.left, box.top, box.width(), box.height());
            return;
        }
        constexpr double quarter = std::numbers::pi / 2;
        cairo_arc(cairo_.get(), box.right - r, box.top + r, r, -quarter, 0);
        cairo_arc(cairo_.get(), box.right - r, box.bottom - r, r, 0, quarter);
        cairo_arc(cairo_.get(), box.left + r, box.bottom - r, r, quarter, 2 * quarter);
        cairo_arc(cairo_.get(), box.left + r, box.top + r, r, 2 * quarter, 3 * quarter);
        cairo_close_path(cairo_.get());
    }

    void set(const std::string& utf8, const TextLook& look) {
        const std::unique_ptr<char, void (*)(void*)> valid{
            g_utf8_make_valid(utf8.data(), gssize(utf8.size())), g_free};
        const Owned<PangoFontDescription> font{pango_font_description_new()};
        pango_font_description_set_family(font.get(), pdf_families_for(valid.get()).c_str());
        pango_font_description_set_weight(font.get(),
                                          look.bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
        pango_font_description_set_absolute_size(font.get(), look.size_px * PANGO_SCALE);
        pango_layout_set_font_description(layout_.get(), font.get());
        pango_layout_set_text(layout_.get(), valid.get(), -1);
    }

    Owned<cairo_t> cairo_;
    Owned<PangoLayout> layout_;
    PdfFonts fonts_;
};

void describe(cairo_surface_t* surface, const PdfSheet& sheet) {
    const auto set = [&](cairo_pdf_metadata_t what, const std::string& text) {
        cairo_pdf_surface_set_metadata(surface, what, text.c_str());
    };
    set(CAIRO_PDF_METADATA_TITLE, sheet.title);
    set(CAIRO_PDF_METADATA_AUTHOR, sheet.author);
    set(CAIRO_PDF_METADATA_CREATOR, "macadam");
    // Without this Cairo would use the current time.
    set(CAIRO_PDF_METADATA_CREATE_DATE, sheet.made.empty() ? "1970-01-01T00:00:00Z" : sheet.made);
}

std::string written(const PdfSheet& sheet, const std::function<void(PdfPage&)>& draw) {
    std::string bytes;
    const double pt_per_px = pt_per_inch / sheet.px_per_inch;
    const Owned<cairo_surface_t> surface{cairo_pdf_surface_create_for_stream(
        append, &bytes, sheet.width_px * pt_per_px, sheet.height_px * pt_per_px)};
    expect(cairo_surface_status(surface.get()));
    describe(surface.get(), sheet);
    {
        CairoPage page{surface.get(), pt_per_px};
        draw(page);
        page.next_page();
        page.expect_well();
    }
    cairo_surface_finish(surface.get());
    expect(cairo_surface_status(surface.get()));
    return bytes;
}

} // namespace
} // namespace macadam

extern "C" void macadam_pdf_write(const macadam::PdfSheet& sheet,
                                  const std::function<void(macadam::PdfPage&)>& draw,
                                  const std::function<void(std::string)>& take) {
    take(macadam::written(sheet, draw));
}
