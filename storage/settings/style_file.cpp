#include "storage/settings/style_file.hpp"

#include "estimator/common/error.hpp"
#include "mapping/style/colour_ramp.hpp"
#include "storage/tables/toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

constexpr std::array<std::string_view, 9> top_keys{
    "theme", "unit", "classes", "class", "ramp", "colours", "lines", "min_passes", "legend"};
constexpr std::array<std::string_view, 3> class_keys{"name", "up_to", "below"};
constexpr std::array<std::string_view, 2> line_keys{"width", "casing"};

constexpr std::int64_t max_passes = 1'000'000;
constexpr std::size_t max_ramp_colours = 64;
constexpr double min_mm_per_m = 0.01;
constexpr double max_mm_per_m = 100; // rougher than any road

constexpr TomlRange line_factor{[](double x) { return 0.25 <= x && x <= 4; },
                                "a number from 0.25 to 4"};

struct ColourKey {
    std::string_view name;
    std::optional<std::uint32_t> ThemeColours::*colour;
};
constexpr std::array colour_keys{ColourKey{"page", &ThemeColours::page},
                                 ColourKey{"ground", &ThemeColours::ground},
                                 ColourKey{"border", &ThemeColours::border},
                                 ColourKey{"ink", &ThemeColours::ink},
                                 ColourKey{"quiet_ink", &ThemeColours::quiet_ink},
                                 ColourKey{"casing", &ThemeColours::casing},
                                 ColourKey{"unmeasured", &ThemeColours::unmeasured},
                                 ColourKey{"few_passes", &ThemeColours::few_passes}};

struct WordKey {
    std::string_view name;
    std::string LegendWords::*word;
    bool has_value; ///< whether {} occurs
};
constexpr std::array word_keys{WordKey{"few_passes", &LegendWords::few_passes, true},
                               WordKey{"uncertain", &LegendWords::uncertain, false},
                               WordKey{"unmeasured", &LegendWords::unmeasured, false},
                               WordKey{"below", &LegendWords::below, true},
                               WordKey{"up_to", &LegendWords::up_to, true},
                               WordKey{"from", &LegendWords::from, true},
                               WordKey{"above", &LegendWords::above, true},
                               WordKey{"all", &LegendWords::all, false}};

template <typename Keys>
std::vector<std::string_view> names_of(const Keys& keys) {
    std::vector<std::string_view> names;
    for (const auto& key : keys) {
        names.push_back(key.name);
    }
    return names;
}

/// Parses "#2c7bb6"; `std::nullopt` if it is not a colour.
std::optional<std::uint32_t> colour_of(std::string_view text) {
    if (text.size() != 7 || text[0] != '#') {
        return {};
    }
    std::uint32_t rgb = 0;
    const auto* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + 1, end, rgb, 16);
    return error == std::errc{} && stop == end ? std::optional{rgb} : std::nullopt;
}

std::string shipped_table(const TomlTable& top) {
    std::vector<std::string_view> names;
    for (const auto& table : class_tables()) {
        names.push_back(table.name);
    }
    return word_among(top, "classes", names);
}

OwnClass class_of(const TomlTable& table, double least, double scale) {
    const bool open = table.has("below");
    if (open && table.has("up_to")) {
        table.refuse("below", "only one of up_to and below");
    }
    const std::string_view key = open ? "below" : "up_to";
    if (!table.has(key)) {
        table.refuse("name", "a limit too: up_to or below; only the last class has none");
    }
    const double border = table.number(key, positive_number);
    if (border <= least * scale) {
        table.refuse(key, fmt::format("more than {:.6g}, the previous limit", least * scale));
    }
    const double to = border / scale;
    if (to < min_mm_per_m || to > max_mm_per_m) {
        table.refuse(key, fmt::format("{} to {}", min_mm_per_m * scale, max_mm_per_m * scale));
    }
    return {table.text("name"), to, open};
}

/// \param scale  from the unit of the file to mm/m
OwnClassTable own_table(const TomlTable& top, const std::string& name, double scale) {
    const auto rows = top.tables("class");
    if (rows.size() < 2 || rows.size() > max_own_classes) {
        throw InputError{fmt::format(
            "{}: {} classes, expected 2 to {}", top.where("class"), rows.size(), max_own_classes)};
    }
    std::vector<OwnClass> classes;
    for (const auto& row : rows) {
        row.expect_only(class_keys);
        if (!row.has("name")) {
            row.miss("name");
        }
        const auto own = row.text("name");
        if (std::ranges::find(classes, own, &OwnClass::name) != classes.end()) {
            row.refuse("name", "a name that no earlier class has");
        }
        if (classes.size() + 1 < rows.size()) {
            classes.push_back(
                class_of(row, classes.empty() ? 0 : classes.back().to_mm_per_m, scale));
            continue;
        }
        for (const std::string_view key : {"up_to", "below"}) {
            if (row.has(key)) {
                row.refuse(key, "no limit, as the last class has none");
            }
        }
        classes.push_back({own, std::numeric_limits<double>::infinity(), false});
    }
    return {name, name, std::move(classes)};
}

/// Reads ramp = "viridis", or [ramp] with colours.
void read_ramp(const TomlTable& top, MapLook& look) {
    if (top.is_text("ramp")) {
        std::vector<std::string_view> names;
        for (const auto& ramp : colour_ramps()) {
            names.push_back(ramp.name);
        }
        look.ramp = word_among(top, "ramp", names);
        return;
    }
    constexpr std::array<std::string_view, 1> ramp_keys{"colours"};
    const auto ramp = top.table("ramp");
    ramp->expect_only(ramp_keys);
    if (!ramp->has("colours")) {
        ramp->miss("colours");
    }
    for (const auto& text : ramp->texts("colours")) {
        const auto rgb = colour_of(text);
        if (!rgb) {
            throw InputError{
                fmt::format("{}: 'ramp.colours' has '{}', expected colours such as \"#2c7bb6\"",
                            ramp->where("colours"),
                            text)};
        }
        look.own_ramp.push_back(*rgb);
    }
    if (look.own_ramp.size() < 2 || look.own_ramp.size() > max_ramp_colours) {
        ramp->refuse("colours",
                     fmt::format("2 to {} colours such as \"#2c7bb6\"", max_ramp_colours));
    }
}

LineFactors lines_of(const TomlTable& table) {
    table.expect_only(line_keys);
    return {.width = table.maybe_number("width", line_factor).value_or(1),
            .casing = table.maybe_number("casing", line_factor).value_or(1)};
}

bool holds_one_value(std::string_view text) {
    const auto first = text.find("{}");
    return first != std::string_view::npos && text.find("{}", first + 2) == std::string_view::npos;
}

LegendWords words_of(const TomlTable& table) {
    auto known = names_of(word_keys);
    known.push_back("title");
    table.expect_only(known);
    LegendWords words;
    words.title = table.maybe_text("title");
    for (const auto& [name, word, has_value] : word_keys) {
        if (!table.has(name)) {
            continue;
        }
        words.*word = table.text(name);
        if (has_value && !holds_one_value(words.*word)) {
            table.refuse(name, "a text with {} once, for the value");
        }
    }
    return words;
}

} // namespace

std::string
word_among(const TomlTable& table, std::string_view key, std::span<const std::string_view> words) {
    auto word = table.text(key);
    if (std::ranges::find(words, word) == words.end()) {
        table.refuse(key, fmt::format("one of {}", fmt::join(words, ", ")));
    }
    return word;
}

ThemeColours read_colours(const TomlTable& table) {
    table.expect_only(names_of(colour_keys));
    ThemeColours colours;
    for (const auto& [name, colour] : colour_keys) {
        if (table.has(name)) {
            colours.*colour = colour_of(table.text(name));
            if (!(colours.*colour)) {
                table.refuse(name, "a colour such as \"#2c7bb6\"");
            }
        }
    }
    return colours;
}

MapLook read_style(const std::filesystem::path& file) {
    const auto top = read_toml(file, "a style");
    top.expect_only(top_keys);
    MapLook look;
    if (top.has("theme")) {
        look.theme = word_among(top, "theme", theme_words);
    }
    if (top.has("unit")) {
        look.unit = word_among(top, "unit", iri_unit_words);
    }
    if (top.has("classes") && top.has("class")) {
        top.refuse("classes", "either classes or tables [[class]]");
    }
    if (top.has("classes")) {
        look.shipped_table = shipped_table(top);
    }
    if (top.has("class")) {
        const double scale = look.unit == "in/mi" ? in_per_mi_of_mm_per_m : 1;
        look.own_table = own_table(top, file.stem().string(), scale);
    }
    if (top.has("ramp")) {
        read_ramp(top, look);
    }
    if (const auto colours = top.table("colours")) {
        look.colours = read_colours(*colours);
    }
    if (const auto lines = top.table("lines")) {
        look.lines = lines_of(*lines);
    }
    if (top.has("min_passes")) {
        look.min_passes = static_cast<int>(top.integer("min_passes", 1, max_passes));
    }
    if (const auto legend = top.table("legend")) {
        look.words = words_of(*legend);
    }
    return look;
}

} // namespace macadam
