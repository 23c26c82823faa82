#include "render/text/pdf_families.hpp"

#include <fmt/format.h>
#include <glib.h>

#include <algorithm>
#include <initializer_list>

namespace macadam {
namespace {

// From fonts-noto-core, first those of scripts that other fonts have too; Pango substitutes
// installed fonts for missing scripts.
constexpr const char* families = "Noto Sans,Noto Sans Arabic,Noto Sans Hebrew,Noto Sans Armenian,"
                                 "Noto Sans Georgian,Noto Sans Lao,{}Noto Sans Math,"
                                 "Noto Sans Symbols2,sans-serif";

/// Returns the font family of a text's Han characters with a comma; "" for a text without them.
std::string cjk_family_for(const std::string& text) {
    const auto has = [&](std::initializer_list<GUnicodeScript> scripts) {
        for (const auto* c = text.c_str(); *c != '\0'; c = g_utf8_next_char(c)) {
            if (std::ranges::find(scripts, g_unichar_get_script(g_utf8_get_char(c))) !=
                scripts.end()) {
                return true;
            }
        }
        return false;
    };
    if (has({G_UNICODE_SCRIPT_HIRAGANA, G_UNICODE_SCRIPT_KATAKANA})) {
        return "Noto Sans CJK JP,";
    }
    if (has({G_UNICODE_SCRIPT_HANGUL})) {
        return "Noto Sans CJK KR,";
    }
    if (has({G_UNICODE_SCRIPT_BOPOMOFO})) {
        return "Noto Sans CJK TC,";
    }
    return has({G_UNICODE_SCRIPT_HAN}) ? "Noto Sans CJK SC," : "";
}

} // namespace

std::string pdf_families_for(const std::string& utf8) {
    return fmt::format(families, cjk_family_for(utf8));
}

} // namespace macadam
