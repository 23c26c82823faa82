#include "render/scene/colour.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace macadam {
namespace {

std::uint32_t mixed(std::uint32_t a, std::uint32_t b, double fraction) {
    std::uint32_t rgb = 0;
    for (const int shift : {16, 8, 0}) {
        const double channel =
            std::lerp(double(a >> shift & 255U), double(b >> shift & 255U), fraction);
        rgb |= std::uint32_t(std::lround(channel)) << shift;
    }
    return rgb;
}

std::uint32_t colour_at(std::span<const std::uint32_t> anchors, double fraction) {
    const double place = fraction * double(anchors.size() - 1);
    const auto before = std::min(anchors.size() - 2, std::size_t(place));
    return mixed(anchors[before], anchors[before + 1], place - double(before));
}

std::span<const std::uint32_t> anchors_of(std::string_view name, std::size_t classes) {
    std::vector<std::string_view> names;
    for (const auto& ramp : colour_ramps()) {
        if (ramp.name == name) {
            return classes == 3 ? ramp.colours_of_three : ramp.colours;
        }
        names.push_back(ramp.name);
    }
    throw InputError{
        fmt::format("unknown colour ramp '{}', expected one of {}", name, fmt::join(names, ", "))};
}

std::vector<std::uint32_t> spread(std::span<const std::uint32_t> anchors, std::size_t classes) {
    std::vector<std::uint32_t> colours;
    colours.reserve(classes);
    for (std::size_t i = 0; i < classes; ++i) {
        colours.push_back(colour_at(anchors, classes > 1 ? double(i) / double(classes - 1) : 0));
    }
    return colours;
}

} // namespace

std::vector<std::uint32_t> ramp_colours(std::string_view ramp, std::size_t classes) {
    return spread(anchors_of(ramp, classes), classes);
}

std::vector<std::uint32_t> class_colours(const MapStyle& style, std::size_t classes) {
    return style.own_ramp.size() < 2 ? ramp_colours(style.ramp, classes)
                                     : spread(style.own_ramp, classes);
}

const ClassTable& classes_of(const MapStyle& style) {
    return style.classes != nullptr ? *style.classes : *class_table("fhwa");
}

Palette palette(MapStyle::Theme theme) {
    switch (theme) {
    case MapStyle::Theme::dark:
        return {.page = 0x141518,
                .ground = 0x1e1e22,
                .border = 0x3a3b41,
                .ink = 0xf2f2ef,
                .quiet_ink = 0xa9adb4,
                .casing = 0xd4d7da,
                .unmeasured = 0x55575e,
                .few_passes = 0x5a5a5a};
    case MapStyle::Theme::print:
        return {.page = 0xffffff,
                .ground = 0xffffff,
                .border = 0x9a9a9a,
                .ink = 0x000000,
                .quiet_ink = 0x404040,
                .casing = 0x1c1c1c,
                .unmeasured = 0xb4b4b4,
                .few_passes = 0xb2b2b2};
    case MapStyle::Theme::light:
        break;
    }
    return {.page = 0xffffff,
            .ground = 0xf4f4f2,
            .border = 0xd6d6d1,
            .ink = 0x1e2328,
            .quiet_ink = 0x5c646c,
            .casing = 0x333b43,
            .unmeasured = 0xb7b8b4,
            .few_passes = 0xb2b2b2};
}

Palette palette(const MapStyle& style) {
    const auto theme = palette(style.theme);
    const auto& own = style.colours;
    return {.page = own.page.value_or(theme.page),
            .ground = own.ground.value_or(theme.ground),
            .border = own.border.value_or(theme.border),
            .ink = own.ink.value_or(theme.ink),
            .quiet_ink = own.quiet_ink.value_or(theme.quiet_ink),
            .casing = own.casing.value_or(theme.casing),
            .unmeasured = own.unmeasured.value_or(theme.unmeasured),
            .few_passes = own.few_passes.value_or(theme.few_passes)};
}

} // namespace macadam
