#include "render/text.hpp"

#include "estimator/common/error.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H
#include <fmt/core.h>
#include <hb-ft.h>
#include <hb.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr const char* regular_file = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr const char* bold_file = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";

// Hinted in height only: strokes are crisp and letters keep their distances at any size.
constexpr FT_Int32 load_flags = FT_LOAD_TARGET_LIGHT;

constexpr double units = 64; // FreeType counts in 1/64 px

struct Glyph {
    FT_UInt index;
    double x_px, y_px; ///< y upwards
};

struct Shaped {
    std::vector<Glyph> glyphs;
    double width_px = 0;
};

std::string without_controls(std::string_view utf8) {
    std::string clean{utf8};
    std::ranges::replace_if(
        clean, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
    return clean;
}

bool continues_character(char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) == 0x80;
}

TextMask blank_for(const std::vector<std::pair<int, int>>& columns, int top, int bottom) {
    TextMask mask;
    if (columns.empty()) {
        return mask;
    }
    mask.left = std::ranges::min(columns, {}, &std::pair<int, int>::first).first;
    mask.width = std::ranges::max(columns, {}, &std::pair<int, int>::second).second - mask.left;
    mask.top = top;
    mask.height = bottom - top;
    mask.coverage.resize(std::size_t(mask.width) * std::size_t(mask.height));
    return mask;
}

} // namespace

struct TypeSetter::Fonts {
    Fonts() {
        if (FT_Init_FreeType(&library) != 0) {
            throw InputError{"FreeType does not start"};
        }
        try {
            regular = opened(regular_file);
            bold = opened(bold_file);
        } catch (...) {
            FT_Done_FreeType(library);
            throw;
        }
    }
    ~Fonts() { FT_Done_FreeType(library); }
    Fonts(const Fonts&) = delete;
    Fonts& operator=(const Fonts&) = delete;

    FT_Face opened(const char* file) const {
        FT_Face face = nullptr;
        if (FT_New_Face(library, file, 0, &face) != 0) {
            throw InputError{fmt::format(
                "{}: cannot read the font, expected the package fonts-dejavu-core", file)};
        }
        return face;
    }

    FT_Face sized(const TextLook& look) const {
        const auto face = look.bold ? bold : regular;
        FT_Set_Char_Size(face, 0, FT_F26Dot6(std::lround(look.size_px * units)), 72, 72);
        return face;
    }

    FT_Library library = nullptr;
    FT_Face regular = nullptr;
    FT_Face bold = nullptr;
};

namespace {

Shaped shaped(FT_Face face, std::string_view utf8) {
    const auto text = without_controls(utf8);
    hb_font_t* font = hb_ft_font_create_referenced(face);
    hb_ft_font_set_load_flags(font, load_flags);
    hb_buffer_t* buffer = hb_buffer_create();
    hb_buffer_add_utf8(buffer, text.data(), int(text.size()), 0, int(text.size()));
    hb_buffer_guess_segment_properties(buffer);
    hb_shape(font, buffer, nullptr, 0);

    unsigned count = 0;
    const auto* infos = hb_buffer_get_glyph_infos(buffer, &count);
    const auto* places = hb_buffer_get_glyph_positions(buffer, &count);
    Shaped result;
    for (unsigned i = 0; i < count; ++i) {
        result.glyphs.push_back({infos[i].codepoint,
                                 result.width_px + places[i].x_offset / units,
                                 places[i].y_offset / units});
        result.width_px += places[i].x_advance / units;
    }
    hb_buffer_destroy(buffer);
    hb_font_destroy(font);
    return result;
}

struct Stamp {
    int left, top, width, height;
    std::vector<std::uint8_t> coverage;
};

/// A glyph where it stands, to a fraction of a pixel.
Stamp stamp(FT_Face face, const Glyph& glyph) {
    const double whole_px = std::floor(glyph.x_px);
    FT_Vector shift{FT_Pos(std::lround((glyph.x_px - whole_px) * units)),
                    FT_Pos(std::lround(glyph.y_px * units))};
    if (FT_Load_Glyph(face, glyph.index, load_flags) != 0) {
        return {};
    }
    FT_Outline_Translate(&face->glyph->outline, shift.x, shift.y);
    if (FT_Render_Glyph(face->glyph, FT_RENDER_MODE_NORMAL) != 0) {
        return {};
    }
    const auto& bitmap = face->glyph->bitmap;
    Stamp made{int(whole_px) + face->glyph->bitmap_left,
               -face->glyph->bitmap_top,
               int(bitmap.width),
               int(bitmap.rows),
               {}};
    for (unsigned row = 0; row < bitmap.rows; ++row) {
        const auto* begin = bitmap.buffer + std::ptrdiff_t(row) * bitmap.pitch;
        made.coverage.insert(made.coverage.end(), begin, begin + bitmap.width);
    }
    return made;
}

} // namespace

TypeSetter::TypeSetter() : fonts_{std::make_unique<Fonts>()} {}
TypeSetter::~TypeSetter() = default;

double TypeSetter::width_px(std::string_view utf8, const TextLook& look) {
    return shaped(fonts_->sized(look), utf8).width_px;
}

TextMask TypeSetter::mask(std::string_view utf8, const TextLook& look) {
    const auto face = fonts_->sized(look);
    std::vector<Stamp> stamps;
    std::vector<std::pair<int, int>> columns;
    int top = 0;
    int bottom = 0;
    for (const auto& glyph : shaped(face, utf8).glyphs) {
        auto made = stamp(face, glyph);
        if (made.coverage.empty()) {
            continue;
        }
        columns.emplace_back(made.left, made.left + made.width);
        top = std::min(top, made.top);
        bottom = std::max(bottom, made.top + made.height);
        stamps.push_back(std::move(made));
    }
    auto mask = blank_for(columns, top, bottom);
    mask.text = without_controls(utf8);
    mask.look = look;
    for (const auto& made : stamps) {
        for (int y = 0; y < made.height; ++y) {
            for (int x = 0; x < made.width; ++x) {
                auto& pixel = mask.coverage[std::size_t(made.top - mask.top + y) * mask.width +
                                            std::size_t(made.left - mask.left + x)];
                pixel = std::max(pixel, made.coverage[std::size_t(y) * made.width + x]);
            }
        }
    }
    return mask;
}

std::vector<std::string>
TypeSetter::wrapped(std::string_view utf8, const TextLook& look, double room_px) {
    const auto text = without_controls(utf8);
    std::vector<std::string> lines;
    std::string line;
    for (std::size_t at = 0; at < text.size();) {
        // A word with the blank before it.
        const auto end = std::min(text.size(), text.find(' ', at + 1));
        auto word = text.substr(at, end - at);
        at = end;
        if (width_px(line + word, look) <= room_px) {
            line += word;
            continue;
        }
        if (!line.empty()) {
            lines.push_back(std::exchange(line, {}));
            word.erase(0, word.find_first_not_of(' '));
        }
        for (std::size_t c = 0; c < word.size();) {
            std::size_t next = c + 1;
            while (next < word.size() && continues_character(word[next])) {
                ++next;
            }
            const auto character = word.substr(c, next - c);
            if (!line.empty() && width_px(line + character, look) > room_px) {
                lines.push_back(std::exchange(line, {}));
            }
            line += character;
            c = next;
        }
    }
    if (!line.empty()) {
        lines.push_back(line);
    }
    return lines;
}

} // namespace macadam
