#include "render/canvas/pdf_rotated_text.hpp"

#include <cairo-ft.h>

#include <cmath>
#include <span>
#include <vector>

namespace macadam {
namespace {

constexpr double same_direction = 0.002; // sine: 0.03 px at the far side of a letter of 13 px

/// Glyphs of one font in one direction, which a page shows in one call.
struct Run {
    const PageGlyph* first;
    std::vector<cairo_glyph_t> glyphs;
};

cairo_glyph_t placed(std::uint32_t index, const GlyphPose& pose) {
    return {index, pose.x_px, pose.y_px};
}

bool goes_on(const PageGlyph& first, const PageGlyph& glyph) {
    return glyph.font == first.font &&
           std::abs(first.pose.along_x * glyph.pose.along_y -
                    first.pose.along_y * glyph.pose.along_x) < same_direction &&
           first.pose.along_x * glyph.pose.along_x + first.pose.along_y * glyph.pose.along_y > 0;
}

std::vector<Run> runs_of(std::span<const PageGlyph> glyphs) {
    std::vector<Run> runs;
    for (const auto& glyph : glyphs) {
        if (runs.empty() || !goes_on(*runs.back().first, glyph)) {
            runs.push_back({&glyph, {}});
        }
        runs.back().glyphs.push_back(placed(glyph.index, glyph.pose));
    }
    return runs;
}

void set_font(cairo_t* cairo, PdfFonts& fonts, const PageGlyph& glyph, double size_px) {
    const double x = size_px * glyph.pose.along_x;
    const double y = size_px * glyph.pose.along_y;
    const cairo_matrix_t turned{x, y, -y, x, 0, 0};
    cairo_set_font_face(cairo, fonts.face(glyph.font));
    cairo_set_font_matrix(cairo, &turned);
}

void set_colour(cairo_t* cairo, std::uint32_t rgb) {
    const auto channel = [&](unsigned shift) { return (rgb >> shift & 255U) / 255.0; };
    cairo_set_source_rgb(cairo, channel(16), channel(8), channel(0));
}

/// Returns the glyph of the current font that has no ink; 0 if there is none.
std::uint32_t blank_of(cairo_t* cairo) {
    auto* const font = cairo_get_scaled_font(cairo);
    auto* const face = cairo_ft_scaled_font_lock_face(font);
    const std::uint32_t blank = face != nullptr ? FT_Get_Char_Index(face, ' ') : 0;
    if (face != nullptr) {
        cairo_ft_scaled_font_unlock_face(font);
    }
    return blank;
}

/// Shows glyphs that represent a text as a whole, so that PDF readers extract it from there.
void show(cairo_t* cairo, const std::string& text, const std::vector<cairo_glyph_t>& glyphs) {
    const cairo_text_cluster_t all{static_cast<int>(text.size()), static_cast<int>(glyphs.size())};
    cairo_show_text_glyphs(cairo,
                           text.c_str(),
                           static_cast<int>(text.size()),
                           glyphs.data(),
                           static_cast<int>(glyphs.size()),
                           &all,
                           1,
                           cairo_text_cluster_flags_t{});
}

/// Returns the runs with ink. Cairo omits glyphs without ink, together with the text that they
/// represent.
std::vector<Run>
inked_runs(cairo_t* cairo, PdfFonts& fonts, std::span<const PageGlyph> glyphs, double size_px) {
    auto runs = runs_of(glyphs);
    std::erase_if(runs, [&](const Run& run) {
        set_font(cairo, fonts, *run.first, size_px);
        cairo_text_extents_t ink;
        cairo_glyph_extents(cairo, run.glyphs.data(), static_cast<int>(run.glyphs.size()), &ink);
        return ink.width <= 0 || ink.height <= 0;
    });
    return runs;
}

void draw_halo(cairo_t* cairo, PdfFonts& fonts, std::span<const Run> runs, const TurnedText& text) {
    cairo_new_path(cairo);
    for (const auto& [first, glyphs] : runs) {
        set_font(cairo, fonts, *first, text.size_px);
        cairo_glyph_path(cairo, glyphs.data(), static_cast<int>(glyphs.size()));
    }
    set_colour(cairo, text.halo_rgb);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_width(cairo, 2 * text.halo_px);
    cairo_stroke(cairo);
}

/// Draws letters with extractable text. PDF readers split words with rotated letters. The first
/// letters therefore represent the whole text, followed by blanks at the positions of the other
/// letters, so that it is found where it is visible; the other letters represent no text.
void draw_letters(cairo_t* cairo,
                  PdfFonts& fonts,
                  std::span<const Run> runs,
                  const TurnedText& text) {
    set_colour(cairo, text.rgb);
    for (std::size_t i = 0; i < runs.size(); ++i) {
        auto glyphs = runs[i].glyphs;
        set_font(cairo, fonts, *runs[i].first, text.size_px);
        if (i > 0) {
            show(cairo, {}, glyphs);
            continue;
        }
        if (const auto blank = blank_of(cairo); blank != 0) {
            for (const auto& run : runs.subspan(1)) {
                for (const auto& [index, x, y] : run.glyphs) {
                    glyphs.push_back({blank, x, y});
                }
            }
        }
        show(cairo, text.standing, glyphs);
    }
}

} // namespace

cairo_font_face_t* PdfFonts::face(const FontSource& font) {
    auto& face = faces_[font];
    if (!face) {
        FcPattern* const pattern = FcPatternCreate();
        FcPatternAddString(pattern,
                           FC_FILE,
                           reinterpret_cast<const FcChar8*>(font.file.c_str())); // NOLINT(*-cast)
        FcPatternAddInteger(pattern, FC_INDEX, static_cast<int>(font.face));
        face.reset(cairo_ft_font_face_create_for_pattern(pattern));
        FcPatternDestroy(pattern);
    }
    return face.get();
}

void draw_turned(cairo_t* cairo, PdfFonts& fonts, const TurnedText& text) {
    cairo_save(cairo);
    const auto runs = inked_runs(cairo, fonts, text.glyphs, text.size_px);
    draw_halo(cairo, fonts, runs, text);
    draw_letters(cairo, fonts, runs, text);
    cairo_restore(cairo);
}

} // namespace macadam
