#include "render/text/font_set.hpp"

#include "estimator/common/error.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H
#include <fmt/core.h>
#include <hb-ft.h>
#include <hb.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

constexpr double units = 64; // FreeType uses 1/64 px

struct FontFile {
    std::string_view script; ///< ISO 15924; "" for fonts tried for every script
    std::string_view name;   ///< path relative to the font folder
    std::string_view regular;
    std::string_view bold; ///< the regular one if there is none
    std::string_view package;
    std::string_view kind = ".ttf";
    long face = 0; ///< index in a file with several faces
};

constexpr FontFile noto(std::string_view script, std::string_view name) {
    return {script, name, "-Regular", "-Bold", "fonts-noto-core"};
}

constexpr FontFile noto_without_bold(std::string_view script, std::string_view name) {
    return {script, name, "-Regular", "-Regular", "fonts-noto-core"};
}

constexpr long japanese = 0;
constexpr long korean = 1;
constexpr long simplified_chinese = 2;
constexpr long traditional_chinese = 3;

/// Returns the font of the shapes that Han characters have in China, Japan or Korea (order of the
/// faces: Noto CJK's README).
constexpr FontFile noto_cjk(std::string_view script, long face) {
    return {
        script, "opentype/noto/NotoSansCJK", "-Regular", "-Bold", "fonts-noto-cjk", ".ttc", face};
}

// For scripts with several fonts in the package, the one for plain running text is listed.
constexpr std::array files{
    noto("", "truetype/noto/NotoSans"), // Latin, Greek, Cyrillic; its figures are tabular
    noto_without_bold("Zyyy", "truetype/noto/NotoSansSymbols2"),
    noto("Zyyy", "truetype/noto/NotoSansSymbols"),
    noto_without_bold("Zyyy", "truetype/noto/NotoSansMath"),
    noto("Adlm", "truetype/noto/NotoSansAdlam"),
    noto("Arab", "truetype/noto/NotoSansArabic"),
    noto("Armn", "truetype/noto/NotoSansArmenian"),
    noto("Bali", "truetype/noto/NotoSansBalinese"),
    noto("Beng", "truetype/noto/NotoSansBengali"),
    noto_cjk("Bopo", traditional_chinese),
    noto_without_bold("Bugi", "truetype/noto/NotoSansBuginese"),
    noto_without_bold("Cakm", "truetype/noto/NotoSansChakma"),
    noto("Cans", "truetype/noto/NotoSansCanadianAboriginal"),
    noto("Cham", "truetype/noto/NotoSansCham"),
    noto("Cher", "truetype/noto/NotoSansCherokee"),
    noto_without_bold("Copt", "truetype/noto/NotoSansCoptic"),
    noto("Deva", "truetype/noto/NotoSansDevanagari"),
    noto("Ethi", "truetype/noto/NotoSansEthiopic"),
    noto("Geor", "truetype/noto/NotoSansGeorgian"),
    noto("Gujr", "truetype/noto/NotoSansGujarati"),
    noto("Guru", "truetype/noto/NotoSansGurmukhi"),
    noto_cjk("Hang", korean),
    noto_cjk("Hani", simplified_chinese),
    noto("Hebr", "truetype/noto/NotoSansHebrew"),
    noto_cjk("Hira", japanese),
    noto("Java", "truetype/noto/NotoSansJavanese"),
    noto_cjk("Kana", japanese),
    noto("Khmr", "truetype/noto/NotoSansKhmer"),
    noto("Knda", "truetype/noto/NotoSansKannada"),
    noto("Lana", "truetype/noto/NotoSansTaiTham"),
    noto("Laoo", "truetype/noto/NotoSansLao"),
    noto_without_bold("Lepc", "truetype/noto/NotoSansLepcha"),
    noto_without_bold("Limb", "truetype/noto/NotoSansLimbu"),
    noto("Lisu", "truetype/noto/NotoSansLisu"),
    noto("Mlym", "truetype/noto/NotoSansMalayalam"),
    noto_without_bold("Mong", "truetype/noto/NotoSansMongolian"),
    noto("Mtei", "truetype/noto/NotoSansMeeteiMayek"),
    noto("Mymr", "truetype/noto/NotoSansMyanmar"),
    noto_without_bold("Nkoo", "truetype/noto/NotoSansNKo"),
    noto("Olck", "truetype/noto/NotoSansOlChiki"),
    noto("Orya", "truetype/noto/NotoSansOriya"),
    noto_without_bold("Osge", "truetype/noto/NotoSansOsage"),
    noto("Rohg", "truetype/noto/NotoSansHanifiRohingya"),
    noto_without_bold("Saur", "truetype/noto/NotoSansSaurashtra"),
    noto("Sinh", "truetype/noto/NotoSansSinhala"),
    noto("Sund", "truetype/noto/NotoSansSundanese"),
    noto_without_bold("Syrc", "truetype/noto/NotoSansSyriac"),
    noto_without_bold("Tale", "truetype/noto/NotoSansTaiLe"),
    noto_without_bold("Talu", "truetype/noto/NotoSansNewTaiLue"),
    noto("Taml", "truetype/noto/NotoSansTamil"),
    noto("Telu", "truetype/noto/NotoSansTelugu"),
    noto_without_bold("Tfng", "truetype/noto/NotoSansTifinagh"),
    noto_without_bold("Tglg", "truetype/noto/NotoSansTagalog"),
    noto("Thaa", "truetype/noto/NotoSansThaana"),
    noto("Thai", "truetype/noto/NotoSansThai"),
    noto("Tibt", "truetype/noto/NotoSerifTibetan"),
    noto_without_bold("Vaii", "truetype/noto/NotoSansVai"),
    noto_without_bold("Yiii", "truetype/noto/NotoSansYi"),
};

/// Returns a font's number: regular, bold, regular, bold, ... in the order of the table.
constexpr int number_of(std::size_t file, bool bold) {
    return static_cast<int>(2 * file + (bold ? 1 : 0));
}

const FontFile& file_of(int font) {
    return files.at(static_cast<std::size_t>(font) / 2);
}

std::string path_of(int font) {
    const auto& file = file_of(font);
    return fmt::format("{}{}{}", file.name, font % 2 == 1 ? file.bold : file.regular, file.kind);
}

} // namespace

std::int32_t level_load_flags() {
    return FT_LOAD_TARGET_LIGHT;
}

FontSet::FontSet(std::filesystem::path folder)
    : folder_{std::move(folder)}, open_(2 * files.size()) {
    if (FT_Init_FreeType(&library_) != 0) {
        throw InputError{"FreeType cannot be initialised"};
    }
    try {
        opened(number_of(0, false));
        opened(number_of(0, true));
    } catch (...) {
        FT_Done_FreeType(library_);
        throw;
    }
}

FontSet::~FontSet() {
    for (auto& font : open_) {
        if (font.shaper != nullptr) {
            hb_font_destroy(font.shaper);
        }
    }
    FT_Done_FreeType(library_);
}

FontSet::Open& FontSet::opened(int font) {
    auto& entry = open_.at(static_cast<std::size_t>(font));
    if (entry.face == nullptr) {
        const auto [file, index] = source(font);
        errno = 0;
        if (FT_New_Face(library_, file.c_str(), index, &entry.face) != 0) {
            entry.face = nullptr;
            throw InputError{
                errno != 0 && errno != ENOENT
                    ? fmt::format("{}: cannot read the font: {}", file, std::strerror(errno))
                    : fmt::format("{}: cannot read the font, expected the package {}",
                                  file,
                                  file_of(font).package)};
        }
    }
    return entry;
}

FontSet::Open& FontSet::sized(int font, double size_px) {
    auto& entry = opened(font);
    const long size = std::lround(size_px * units);
    if (entry.size != size) {
        FT_Set_Char_Size(entry.face, 0, size, 72, 72);
        entry.size = size;
        if (entry.shaper != nullptr) {
            hb_ft_font_changed(entry.shaper);
        }
    }
    if (entry.shaper == nullptr) {
        entry.shaper = hb_ft_font_create_referenced(entry.face);
        hb_ft_font_set_load_flags(entry.shaper, level_load_flags());
    }
    return entry;
}

std::vector<int> FontSet::fonts_for(std::uint32_t script, bool bold) {
    std::vector<int> fonts;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const auto own = files[i].script;
        if (own.empty() || hb_tag_from_string(own.data(), int(own.size())) == script) {
            fonts.push_back(number_of(i, bold));
        }
    }
    return fonts;
}

std::vector<int> FontSet::symbol_fonts() {
    std::vector<int> fonts;
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (files[i].script == "Zyyy") {
            fonts.push_back(number_of(i, false));
        }
    }
    return fonts;
}

FontSource FontSet::source(int font) const {
    return {(folder_ / path_of(font)).string(), file_of(font).face};
}

bool FontSet::has(int font, char32_t character) {
    return FT_Get_Char_Index(opened(font).face, character) != 0;
}

FT_FaceRec_* FontSet::face(int font, double size_px) {
    return sized(font, size_px).face;
}

hb_font_t* FontSet::shaper(int font, double size_px) {
    return sized(font, size_px).shaper;
}

} // namespace macadam
