#include "render/text/text_runs.hpp"

#include <fribidi.h>
#include <hb.h>

#include <algorithm>
#include <iterator>
#include <new>
#include <optional>
#include <utility>

namespace macadam {
namespace {

struct Character {
    std::uint32_t script;
    int level; ///< embedding level; odd: right to left
    int font = -1;
};

bool belongs_to_no_script(hb_script_t script) {
    return script == HB_SCRIPT_COMMON || script == HB_SCRIPT_INHERITED ||
           script == HB_SCRIPT_UNKNOWN;
}

/// Returns the script of Han characters, whose shapes differ between Japan, Korea, Taiwan and
/// China. They take the script of adjacent letters, and by default that of China.
std::uint32_t script_of_han(std::u32string_view text) {
    auto* const unicode = hb_unicode_funcs_get_default();
    for (const auto script :
         {HB_SCRIPT_HIRAGANA, HB_SCRIPT_KATAKANA, HB_SCRIPT_HANGUL, HB_SCRIPT_BOPOMOFO}) {
        if (std::ranges::any_of(
                text, [&](char32_t c) { return hb_unicode_script(unicode, c) == script; })) {
            return script;
        }
    }
    return HB_SCRIPT_HAN;
}

/// Assigns scripts to characters. Signs and marks take the script of the preceding character, or at
/// the start that of the following one.
std::vector<std::uint32_t> scripts_of(std::u32string_view text) {
    auto* const unicode = hb_unicode_funcs_get_default();
    const auto han = script_of_han(text);
    std::vector<std::uint32_t> scripts(text.size(), HB_SCRIPT_COMMON);
    std::optional<std::uint32_t> known;
    for (std::size_t i = 0; i < text.size(); ++i) {
        auto script = hb_unicode_script(unicode, text[i]);
        script = script == HB_SCRIPT_HAN ? static_cast<hb_script_t>(han) : script;
        if (!belongs_to_no_script(script)) {
            if (!known) {
                std::fill_n(scripts.begin(), i, std::uint32_t(script));
            }
            known = script;
        }
        scripts[i] = known.value_or(HB_SCRIPT_COMMON);
    }
    return scripts;
}

/// Result of the bidirectional algorithm for a line.
struct LineOrder {
    std::vector<FriBidiLevel> levels; ///< embedding levels
    std::vector<FriBidiCharType> types;
    FriBidiParType direction;
};

LineOrder order_of(std::u32string_view text) {
    const auto length = FriBidiStrIndex(text.size());
    const std::vector<FriBidiChar> characters(text.begin(), text.end());
    std::vector<FriBidiCharType> types(text.size());
    std::vector<FriBidiBracketType> brackets(text.size());
    std::vector<FriBidiLevel> levels(text.size());
    fribidi_get_bidi_types(characters.data(), length, types.data());
    fribidi_get_bracket_types(characters.data(), length, types.data(), brackets.data());
    FriBidiParType direction = FRIBIDI_PAR_ON; // direction of the first letter
    if (fribidi_get_par_embedding_levels_ex(
            types.data(), brackets.data(), length, &direction, levels.data()) == 0) {
        throw std::bad_alloc{}; // its only failure
    }
    return {std::move(levels), std::move(types), direction};
}

/// Returns true for control characters without a shape of their own.
bool is_silent(char32_t c) {
    return c == 0xAD || (0x200B <= c && c <= 0x200F) || (0x202A <= c && c <= 0x202E) ||
           (0x2060 <= c && c <= 0x206F) || (0xFE00 <= c && c <= 0xFE0F) || c == 0xFEFF;
}

int first_with(const std::vector<int>& fonts, char32_t c, FontSet& shelf) {
    const auto found = std::ranges::find_if(fonts, [&](int font) { return shelf.has(font, c); });
    return found == fonts.end() ? -1 : *found;
}

/// Returns the first font that has all letters of a script's run, or most of them, so that the
/// letters of one word come from one font.
int main_font(std::u32string_view run, const std::vector<int>& fonts, FontSet& shelf) {
    int best = fonts.front();
    std::ptrdiff_t most = -1;
    for (const int font : fonts) {
        const auto count = std::ranges::count_if(
            run, [&](char32_t c) { return is_silent(c) || shelf.has(font, c); });
        if (count > most) {
            best = font;
            most = count;
        }
        if (count == std::ptrdiff_t(run.size())) {
            break;
        }
    }
    return best;
}

void choose_fonts(std::vector<Character>& characters,
                  std::u32string_view text,
                  bool bold,
                  FontSet& shelf) {
    for (std::size_t first = 0; first < text.size();) {
        std::size_t last = first;
        while (last < text.size() && characters[last].script == characters[first].script) {
            ++last;
        }
        auto fonts = shelf.fonts_for(characters[first].script, bold);
        const int main = main_font(text.substr(first, last - first), fonts, shelf);
        for (std::size_t i = first; i < last; ++i) {
            auto& font = characters[i].font;
            font = is_silent(text[i]) || shelf.has(main, text[i])
                       ? main
                       : first_with(fonts, text[i], shelf);
            if (font < 0) {
                font = first_with(FontSet::symbol_fonts(), text[i], shelf);
            }
        }
        first = last;
    }
}

std::vector<Character> characters_with_looks(std::u32string_view text, bool bold, FontSet& shelf) {
    const auto scripts = scripts_of(text);
    const auto levels = order_of(text).levels;
    std::vector<Character> characters;
    characters.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        characters.push_back({.script = scripts[i], .level = levels[i]});
    }
    choose_fonts(characters, text, bold, shelf);
    return characters;
}

struct LevelRun {
    TextRun run;
    int level;
};

/// Rule L2: from the highest level to the lowest odd one, reverses all runs at that level or above.
void order(std::vector<LevelRun>& runs) {
    int highest = 0;
    for (const auto& run : runs) {
        highest = std::max(highest, run.level);
    }
    for (int level = highest; level > 0; --level) {
        for (auto first = runs.begin(); first != runs.end();) {
            first = std::find_if(first, runs.end(), [&](auto& run) { return run.level >= level; });
            const auto last =
                std::find_if(first, runs.end(), [&](auto& run) { return run.level < level; });
            std::reverse(first, last);
            first = last;
        }
    }
}

} // namespace

std::u32string characters_of(std::string_view utf8) {
    hb_buffer_t* buffer = hb_buffer_create();
    hb_buffer_add_utf8(buffer, utf8.data(), int(utf8.size()), 0, int(utf8.size()));
    unsigned count = 0;
    const auto* infos = hb_buffer_get_glyph_infos(buffer, &count);
    std::u32string characters;
    for (unsigned i = 0; i < count; ++i) {
        characters.push_back(infos[i].codepoint);
    }
    hb_buffer_destroy(buffer);
    return characters;
}

std::string utf8_of(std::u32string_view characters) {
    constexpr std::size_t max_bytes = 4; // per character
    std::string utf8(characters.size() * max_bytes + 1, '\0');
    const std::vector<FriBidiChar> plain(characters.begin(), characters.end());
    const auto size = fribidi_unicode_to_charset(
        FRIBIDI_CHAR_SET_UTF8, plain.data(), FriBidiStrIndex(plain.size()), utf8.data());
    utf8.resize(std::size_t(size));
    return utf8;
}

std::u32string in_visual_order(std::u32string text) {
    if (text.empty()) {
        return text;
    }
    auto [levels, types, direction] = order_of(text);
    std::vector<FriBidiChar> standing(text.begin(), text.end());
    if (fribidi_reorder_line(0,
                             types.data(),
                             FriBidiStrIndex(standing.size()),
                             0,
                             direction,
                             levels.data(),
                             standing.data(),
                             nullptr) == 0) {
        throw std::bad_alloc{}; // its only failure
    }
    return {standing.begin(), standing.end()};
}

std::vector<TextRun> runs_of(std::u32string_view text, bool bold, FontSet& shelf) {
    if (text.empty()) {
        return {};
    }
    const auto characters = characters_with_looks(text, bold, shelf);
    std::vector<LevelRun> runs;
    for (std::size_t i = 0; i < characters.size(); ++i) {
        const auto& [script, level, font] = characters[i];
        if (i == 0 || script != runs.back().run.script || level != runs.back().level ||
            font != runs.back().run.font) {
            runs.push_back({{i, 0, script, font, level % 2 == 1}, level});
        }
        ++runs.back().run.count;
    }
    order(runs);
    std::vector<TextRun> ordered;
    ordered.reserve(runs.size());
    std::ranges::transform(runs, std::back_inserter(ordered), &LevelRun::run);
    return ordered;
}

} // namespace macadam
