#include "render/scene/style_check.hpp"

#include "render/scene/colour.hpp"
#include "render/scene/colour_difference.hpp"

#include <fmt/format.h>

namespace macadam {

std::vector<std::string> style_warnings(const MapStyle& style, const ClassTable& classes) {
    std::vector<std::string> warnings;
    const auto colours = class_colours(style, classes.classes.size());
    if (colours.size() > 1) {
        const auto [a, b, sight, difference] = nearest_colours(colours);
        if (difference < min_class_difference) {
            warnings.push_back(
                fmt::format("the colours of '{}' (#{:06x}) and '{}' (#{:06x}) differ by {:.1f} "
                            "CIEDE2000 with {}, expected {} or more",
                            classes.classes[a].name,
                            colours[a],
                            classes.classes[b].name,
                            colours[b],
                            difference,
                            name_of(sight),
                            min_class_difference));
        }
    }
    const auto theme = palette(style);
    const double contrast = contrast_ratio(theme.casing, theme.ground);
    if (contrast < min_casing_contrast) {
        warnings.push_back(fmt::format("the casing (#{:06x}) has a contrast of {:.1f} to the "
                                       "ground (#{:06x}), expected {} or more",
                                       theme.casing,
                                       contrast,
                                       theme.ground,
                                       min_casing_contrast));
    }
    return warnings;
}

} // namespace macadam
