#include "render/font_shelf.hpp"

#include "estimator/common/error.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H
#include <fmt/core.h>
#include <hb-ft.h>
#include <hb.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

constexpr double units = 64; // FreeType counts in 1/64 px

struct FontFile {
    std::string_view script; ///< ISO 15924; "" for those that every script tries
    std::string_view name;   ///< below the folder of fonts
    std::string_view regular;
    std::string_view bold; ///< the regular one where there is none
    std::string_view package;
};

constexpr FontFile noto(std::string_view script, std::string_view name) {
    return {script, name, "-Regular", "-Bold", "fonts-noto-core"};
}

constexpr FontFile noto_without_bold(std::string_view script, std::string_view name) {
    return {script, name, "-Regular", "-Regular", "fonts-noto-core"};
}

// Where a script has several fonts in the package the one for plain running text is taken.
constexpr std::array files{
    FontFile{"", "dejavu/DejaVuSans", "", "-Bold", "fonts-dejavu-core"},
    noto("", "noto/NotoSans"), // what DejaVu lacks of Latin, Greek and Cyrillic
    noto_without_bold("Zyyy", "noto/NotoSansSymbols2"),
    noto("Zyyy", "noto/NotoSansSymbols"),
    noto_without_bold("Zyyy", "noto/NotoSansMath"),
    noto("Adlm", "noto/NotoSansAdlam"),
    noto("Arab", "noto/NotoSansArabic"),
    noto("Armn", "noto/NotoSansArmenian"),
    noto("Bali", "noto/NotoSansBalinese"),
    noto("Beng", "noto/NotoSansBengali"),
    noto_without_bold("Bugi", "noto/NotoSansBuginese"),
    noto_without_bold("Cakm", "noto/NotoSansChakma"),
    noto("Cans", "noto/NotoSansCanadianAboriginal"),
    noto("Cham", "noto/NotoSansCham"),
    noto("Cher", "noto/NotoSansCherokee"),
    noto_without_bold("Copt", "noto/NotoSansCoptic"),
    noto("Deva", "noto/NotoSansDevanagari"),
    noto("Ethi", "noto/NotoSansEthiopic"),
    noto("Geor", "noto/NotoSansGeorgian"),
    noto("Gujr", "noto/NotoSansGujarati"),
    noto("Guru", "noto/NotoSansGurmukhi"),
    noto("Hebr", "noto/NotoSansHebrew"),
    noto("Java", "noto/NotoSansJavanese"),
    noto("Khmr", "noto/NotoSansKhmer"),
    noto("Knda", "noto/NotoSansKannada"),
    noto("Lana", "noto/NotoSansTaiTham"),
    noto("Laoo", "noto/NotoSansLao"),
    noto_without_bold("Lepc", "noto/NotoSansLepcha"),
    noto_without_bold("Limb", "noto/NotoSansLimbu"),
    noto("Lisu", "noto/NotoSansLisu"),
    noto("Mlym", "noto/NotoSansMalayalam"),
    noto_without_bold("Mong", "noto/NotoSansMongolian"),
    noto("Mtei", "noto/NotoSansMeeteiMayek"),
    noto("Mymr", "noto/NotoSansMyanmar"),
    noto_without_bold("Nkoo", "noto/NotoSansNKo"),
    noto("Olck", "noto/NotoSansOlChiki"),
    noto("Orya", "noto/NotoSansOriya"),
    noto_without_bold("Osge", "noto/NotoSansOsage"),
    noto("Rohg", "noto/NotoSansHanifiRohingya"),
    noto_without_bold("Saur", "noto/NotoSansSaurashtra"),
    noto("Sinh", "noto/NotoSansSinhala"),
    noto("Sund", "noto/NotoSansSundanese"),
    noto_without_bold("Syrc", "noto/NotoSansSyriac"),
    noto_without_bold("Tale", "noto/NotoSansTaiLe"),
    noto_without_bold("Talu", "noto/NotoSansNewTaiLue"),
    noto("Taml", "noto/NotoSansTamil"),
    noto("Telu", "noto/NotoSansTelugu"),
    noto_without_bold("Tfng", "noto/NotoSansTifinagh"),
    noto_without_bold("Tglg", "noto/NotoSansTagalog"),
    noto("Thaa", "noto/NotoSansThaana"),
    noto("Thai", "noto/NotoSansThai"),
    noto("Tibt", "noto/NotoSerifTibetan"),
    noto_without_bold("Vaii", "noto/NotoSansVai"),
    noto_without_bold("Yiii", "noto/NotoSansYi"),
};

/// Fonts are numbered regular, bold, regular, bold, ... in the order of the table.
constexpr int number_of(std::size_t file, bool bold) {
    return static_cast<int>(2 * file + (bold ? 1 : 0));
}

const FontFile& file_of(int font) {
    return files.at(static_cast<std::size_t>(font) / 2);
}

std::string path_of(int font) {
    const auto& file = file_of(font);
    return fmt::format("{}{}.ttf", file.name, font % 2 == 1 ? file.bold : file.regular);
}

} // namespace

std::int32_t level_load_flags() {
    return FT_LOAD_TARGET_LIGHT;
}

FontShelf::FontShelf(std::filesystem::path folder)
    : folder_{std::move(folder)}, open_(2 * files.size()) {
    if (FT_Init_FreeType(&library_) != 0) {
        throw InputError{"FreeType does not start"};
    }
    try {
        opened(number_of(0, false));
        opened(number_of(0, true));
    } catch (...) {
        FT_Done_FreeType(library_);
        throw;
    }
}

FontShelf::~FontShelf() {
    for (auto& font : open_) {
        if (font.shaper != nullptr) {
            hb_font_destroy(font.shaper);
        }
    }
    FT_Done_FreeType(library_);
}

FontShelf::Open& FontShelf::opened(int font) {
    auto& entry = open_.at(static_cast<std::size_t>(font));
    if (entry.face == nullptr) {
        const auto path = file(font);
        if (FT_New_Face(library_, path.c_str(), 0, &entry.face) != 0) {
            entry.face = nullptr;
            throw InputError{fmt::format(
                "{}: cannot read the font, expected the package {}", path, file_of(font).package)};
        }
    }
    return entry;
}

FontShelf::Open& FontShelf::sized(int font, double size_px) {
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

std::vector<int> FontShelf::fonts_for(std::uint32_t script, bool bold) {
    std::vector<int> fonts;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const auto own = files[i].script;
        if (own.empty() || hb_tag_from_string(own.data(), int(own.size())) == script) {
            fonts.push_back(number_of(i, bold));
        }
    }
    return fonts;
}

std::vector<int> FontShelf::symbol_fonts() {
    std::vector<int> fonts;
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (files[i].script == "Zyyy") {
            fonts.push_back(number_of(i, false));
        }
    }
    return fonts;
}

std::string FontShelf::file(int font) const {
    return (folder_ / path_of(font)).string();
}

bool FontShelf::has(int font, char32_t character) {
    return FT_Get_Char_Index(opened(font).face, character) != 0;
}

FT_FaceRec_* FontShelf::face(int font, double size_px) {
    return sized(font, size_px).face;
}

hb_font_t* FontShelf::shaper(int font, double size_px) {
    return sized(font, size_px).shaper;
}

} // namespace macadam
