#include "render/text/text_shaping.hpp"

#include "render/text/font_set.hpp"
#include "render/text/text_runs.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <hb.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr const char* fonts_folder = "/usr/share/fonts"; // as in Debian's packages
constexpr double units = 64;                             // FreeType uses 1/64 px

bool continues_character(char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) == 0x80;
}

std::string without_controls(std::string_view utf8) {
    std::string clean{utf8};
    std::ranges::replace_if(
        clean, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
    return clean;
}

/// Adds a glyph. Glyphs of one character are consecutive.
void add_glyph(SetLine& line, const SetGlyph& glyph, bool new_cluster, double right_px) {
    if (new_cluster) {
        line.clusters.push_back({line.glyphs.size(), 0, line.width_px, line.width_px});
    }
    line.glyphs.push_back(glyph);
    ++line.clusters.back().count;
    line.clusters.back().right_px = right_px;
}

void add_run(SetLine& line, const TextRun& run, std::u32string_view text, hb_font_t* font) {
    hb_buffer_t* buffer = hb_buffer_create();
    // The whole text provides context for letters at the run's ends.
    hb_buffer_add_utf32(buffer,
                        reinterpret_cast<const std::uint32_t*>(text.data()), // NOLINT
                        int(text.size()),
                        unsigned(run.first),
                        int(run.count));
    hb_buffer_set_direction(buffer, run.leftwards ? HB_DIRECTION_RTL : HB_DIRECTION_LTR);
    hb_buffer_set_script(buffer, hb_script_from_iso15924_tag(run.script));
    hb_buffer_set_language(buffer, hb_language_from_string("und", -1)); // on every machine
    hb_shape(font, buffer, nullptr, 0);

    unsigned count = 0;
    const auto* infos = hb_buffer_get_glyph_infos(buffer, &count);
    const auto* places = hb_buffer_get_glyph_positions(buffer, &count);
    for (unsigned i = 0; i < count; ++i) {
        const double right_px = line.width_px + places[i].x_advance / units;
        add_glyph(line,
                  {run.font,
                   infos[i].codepoint,
                   line.width_px + places[i].x_offset / units,
                   places[i].y_offset / units},
                  i == 0 || infos[i].cluster != infos[i - 1].cluster,
                  right_px);
        line.width_px = right_px;
    }
    hb_buffer_destroy(buffer);
}

bool is_level(const GlyphPose& pose) {
    return pose.along_x == 1 && pose.along_y == 0;
}

FT_Fixed fixed(double value) {
    return FT_Fixed(std::lround(value * 65536));
}

TextMask mask_of(const FT_GlyphSlot& slot, int left, int top) {
    const auto& bitmap = slot->bitmap;
    TextMask made{
        left + slot->bitmap_left, top - slot->bitmap_top, int(bitmap.width), int(bitmap.rows), {}};
    for (unsigned row = 0; row < bitmap.rows; ++row) {
        const auto* begin = bitmap.buffer + std::ptrdiff_t(row) * bitmap.pitch;
        made.coverage.insert(made.coverage.end(), begin, begin + bitmap.width);
    }
    return made;
}

} // namespace

struct TypeSetter::ShapingCache {
    explicit ShapingCache(const std::filesystem::path& fonts) : shelf{fonts} {}
    FontSet shelf;
};

TypeSetter::TypeSetter() : TypeSetter{fonts_folder} {}
TypeSetter::TypeSetter(const std::filesystem::path& fonts)
    : desk_{std::make_unique<ShapingCache>(fonts)} {}
TypeSetter::~TypeSetter() = default;
TypeSetter::TypeSetter(TypeSetter&&) noexcept = default;
TypeSetter& TypeSetter::operator=(TypeSetter&&) noexcept = default;

SetLine TypeSetter::set(std::string_view utf8, const TextLook& look) {
    const auto text = characters_of(without_controls(utf8));
    SetLine line;
    for (const auto& run : runs_of(text, look.bold, desk_->shelf)) {
        if (run.font < 0) {
            line.whole = false;
        } else {
            add_run(line, run, text, desk_->shelf.shaper(run.font, look.size_px));
        }
    }
    return line;
}

TextMask TypeSetter::stamp(const SetGlyph& glyph, const TextLook& look, const GlyphPose& pose) {
    const auto face = desk_->shelf.face(glyph.font, look.size_px);
    const FT_Int32 flags = is_level(pose) ? level_load_flags() : FT_Int32{FT_LOAD_NO_HINTING};
    if (FT_Load_Glyph(face, glyph.index, flags) != 0 ||
        face->glyph->format != FT_GLYPH_FORMAT_OUTLINE) {
        return {};
    }
    auto* outline = &face->glyph->outline;
    if (!is_level(pose)) {
        const FT_Matrix turn{fixed(pose.along_x),
                             fixed(pose.along_y),
                             fixed(-pose.along_y),
                             fixed(pose.along_x)}; // FreeType's y axis points upwards
        FT_Outline_Transform(outline, &turn);
    }
    const double left = std::floor(pose.x_px);
    const double top = std::floor(pose.y_px);
    FT_Outline_Translate(outline,
                         FT_Pos(std::lround((pose.x_px - left) * units)),
                         -FT_Pos(std::lround((pose.y_px - top) * units)));
    if (FT_Render_Glyph(face->glyph, FT_RENDER_MODE_NORMAL) != 0) {
        return {};
    }
    return mask_of(face->glyph, int(left), int(top));
}

std::string TypeSetter::as_it_stands(std::string_view utf8) {
    return utf8_of(in_visual_order(characters_of(without_controls(utf8))));
}

FontSource TypeSetter::source(int font) const {
    return desk_->shelf.source(font);
}

double TypeSetter::width_px(std::string_view utf8, const TextLook& look) {
    return set(utf8, look).width_px;
}

TextMask TypeSetter::mask(std::string_view utf8, const TextLook& look) {
    std::vector<TextMask> stamps;
    for (const auto& glyph : set(utf8, look).glyphs) {
        stamps.push_back(stamp(glyph, look, {glyph.x_px, -glyph.y_px}));
    }
    auto mask = merged(stamps);
    mask.text = without_controls(utf8);
    mask.look = look;
    return mask;
}

std::vector<std::string>
TypeSetter::wrapped(std::string_view utf8, const TextLook& look, double room_px) {
    const auto text = without_controls(utf8);
    std::vector<std::string> lines;
    std::string line;
    for (std::size_t at = 0; at < text.size();) {
        // Takes a word with the blank before it.
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

TextMask merged(const std::vector<TextMask>& masks) {
    TextMask whole;
    int right = 0;
    int bottom = 0;
    bool any = false;
    for (const auto& mask : masks) {
        if (mask.coverage.empty()) {
            continue;
        }
        whole.left = any ? std::min(whole.left, mask.left) : mask.left;
        whole.top = any ? std::min(whole.top, mask.top) : mask.top;
        right = any ? std::max(right, mask.left + mask.width) : mask.left + mask.width;
        bottom = any ? std::max(bottom, mask.top + mask.height) : mask.top + mask.height;
        any = true;
    }
    whole.width = right - whole.left;
    whole.height = bottom - whole.top;
    whole.coverage.resize(std::size_t(whole.width) * std::size_t(whole.height));
    for (const auto& mask : masks) {
        for (int y = 0; y < mask.height; ++y) {
            for (int x = 0; x < mask.width; ++x) {
                auto& pixel = whole.coverage[std::size_t(mask.top - whole.top + y) * whole.width +
                                             std::size_t(mask.left - whole.left + x)];
                pixel = std::max(pixel, mask.coverage[std::size_t(y) * mask.width + x]);
            }
        }
    }
    return whole;
}

} // namespace macadam
