#include "app/render/style_options.hpp"

#include "render/scene/style_check.hpp"
#include "storage/settings/style_file.hpp"

#include <fmt/format.h>

#include <utility>

namespace macadam {
namespace {

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
    style.colours = look.colours;
    style.lines = look.lines;
    style.min_passes = look.min_passes.value_or(1);
    style.in_per_mi = look.unit == "in/mi";
    style.words = std::move(look.words);
    return style;
}

} // namespace

MapStyle parse_style_file(const Arguments& arguments) {
    const auto file = arguments.value("--style");
    return file ? style_of(read_style(*file)) : MapStyle{};
}

std::optional<int> grey_below(const Arguments& arguments) {
    constexpr std::int64_t most = 1'000'000;
    const auto passes = arguments.integer("--grey-below");
    if (passes && (*passes < 1 || *passes > most)) {
        throw UsageError{fmt::format("--grey-below is {}, expected 1 to {}", *passes, most)};
    }
    return passes ? std::optional{static_cast<int>(*passes)} : std::nullopt;
}

void warn_of_look(const MapStyle& style, const Console& console) {
    for (const auto& warning : style_warnings(style, *style.classes)) {
        console.warn(warning);
    }
}

} // namespace macadam
