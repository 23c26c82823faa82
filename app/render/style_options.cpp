#include "app/render/style_options.hpp"

#include "app/database/server_store.hpp"
#include "app/output/units_option.hpp"
#include "estimator/common/error.hpp"
#include "mapping/style/print_ramp.hpp"
#include "render/scene/style_check.hpp"
#include "storage/settings/database_appearance.hpp"
#include "storage/settings/style_file.hpp"

#include <fmt/format.h>

#include <utility>

namespace macadam {
namespace {

/// Sets a value from an option of this command. A default of the option does not replace what the
/// style file states.
/// \returns whether the option determines the value
bool prefer(std::optional<std::string>& value,
            bool is_stated,
            const Arguments& arguments,
            std::string_view option) {
    if (!arguments.has(option) || !arguments.value(option) ||
        (is_stated && !arguments.is_given(option))) {
        return false;
    }
    value = arguments.value(option);
    return true;
}

MapLook user_look(const Arguments& arguments) {
    const auto file = arguments.value("--style");
    auto look = file ? read_style(*file) : MapLook{};
    prefer(look.theme, look.theme.has_value(), arguments, "--theme");
    if (prefer(look.unit, look.unit.has_value(), arguments, "--units")) {
        look.unit = parse_units(arguments) == UnitSystem::us ? "in/mi" : "mm/m";
    }
    if (prefer(look.ramp, look.ramp || !look.own_ramp.empty(), arguments, "--ramp")) {
        look.own_ramp.clear();
    }
    if (prefer(look.shipped_table, look.shipped_table || look.own_table, arguments, "--classes")) {
        look.own_table.reset();
    }
    return look;
}

/// Reads the appearance beside a database. A file that is wrong must not make the database
/// unusable.
DatabaseAppearance appearance_of(const std::filesystem::path& store, const Console& console) {
    const auto file = appearance_file_of(store);
    try {
        if (auto appearance = read_appearance(file)) {
            console.detail(fmt::format("appearance suggested by {}", file.string()));
            return *std::move(appearance);
        }
    } catch (const InputError& error) {
        console.warn(fmt::format("{}; the file is ignored", error.what()));
    }
    return {};
}

} // namespace

MapStyle style_of(MapLook look) {
    MapStyle style;
    if (look.theme) {
        style.theme = *look.theme == "dark"    ? MapStyle::Theme::dark
                      : *look.theme == "print" ? MapStyle::Theme::print
                                               : MapStyle::Theme::light;
    }
    if (look.shipped_table) {
        style.classes = class_table(*look.shipped_table);
    }
    if (look.own_table) {
        style.own_classes = std::move(look.own_table);
        style.classes = &style.own_classes->table();
    }
    if (look.ramp) {
        style.ramp = *look.ramp;
    }
    style.own_ramp = std::move(look.own_ramp);
    if (style.theme == MapStyle::Theme::print && !look.ramp && style.own_ramp.empty()) {
        style.own_ramp.assign(print_ramp.begin(), print_ramp.end());
    }
    style.colours = look.colours;
    style.lines = look.lines;
    style.min_passes = look.min_passes.value_or(1);
    style.in_per_mi = look.unit == "in/mi";
    style.words = std::move(look.words);
    return style;
}

ChosenLook
parse_look(const Arguments& arguments, const std::filesystem::path& store, const Console& console) {
    ChosenLook chosen{.look = user_look(arguments), .language = {}};
    prefer(chosen.language, false, arguments, "--language");
    const auto suggested = appearance_of(store, console);
    const auto add = [](auto& value, const auto& more) { value = value ? value : more; };
    add(chosen.look.unit, suggested.unit);
    add(chosen.language, suggested.language);
    if (arguments.has("--theme")) {
        add(chosen.look.theme, suggested.theme);
    }
    const auto suits = suggested.theme.value_or("light");
    if (!arguments.value("--style") && chosen.look.theme.value_or("light") == suits) {
        chosen.look.colours = suggested.colours; // chosen for the ground of that theme
    }
    return chosen;
}

std::optional<int> grey_below(const Arguments& arguments) {
    constexpr std::int64_t most = 1'000'000;
    const auto passes = arguments.integer("--grey-below");
    if (passes && (*passes < 1 || *passes > most)) {
        throw UsageError{fmt::format("--grey-below is {}, expected 1 to {}", *passes, most)};
    }
    return passes ? std::optional{static_cast<int>(*passes)} : std::nullopt;
}

MapStyle parse_style(const Arguments& arguments, const Console& console) {
    auto style = style_of(parse_look(arguments, file_or_server(arguments), console).look);
    style.left_hand_traffic = arguments.flag("--left-hand");
    style.labels = !arguments.flag("--no-labels");
    style.min_passes = grey_below(arguments).value_or(style.min_passes);
    return style;
}

void warn_of_look(const MapStyle& style, const Console& console) {
    for (const auto& warning : style_warnings(style, *style.classes)) {
        console.warn(warning);
    }
}

} // namespace macadam
