#include "storage/styles/class_limits.hpp"

#include "mapping/style/class_colours.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

std::uint32_t rgb_of(const ClassTable& classes, std::size_t index) {
    return class_rgb(index, classes.classes.size());
}

} // namespace

double in_units_of(const RoadStyle& style, double mm_per_m) {
    return style.units == UnitSystem::us ? mm_per_m * in_per_mi_of_mm_per_m : mm_per_m;
}

double lower_limit(const RoadStyle& style, std::size_t index) {
    return index == 0 ? 0 : upper_limit(style, index - 1);
}

double upper_limit(const RoadStyle& style, std::size_t index) {
    return in_units_of(style, style.classes.classes[index].to_mm_per_m);
}

std::string class_label(const RoadStyle& style, std::size_t index) {
    const bool us = style.units == UnitSystem::us;
    const auto limit = [&](double value) { return fmt::format("{:.{}f}", value, us ? 0 : 2); };
    const auto* const unit = us ? "in/mi" : "mm/m";
    const auto count = style.classes.classes.size();
    const auto limits =
        count == 1           ? std::string{"all"}
        : index == 0         ? fmt::format("below {} {}", limit(upper_limit(style, index)), unit)
        : index + 1 == count ? fmt::format("above {} {}", limit(lower_limit(style, index)), unit)
                             : fmt::format("{} to {} {}",
                                           limit(lower_limit(style, index)),
                                           limit(upper_limit(style, index)),
                                           unit);
    return fmt::format("{} ({})", style.classes.classes[index].name, limits);
}

std::string class_colour_numbers(const ClassTable& classes, std::size_t index) {
    const auto rgb = rgb_of(classes, index);
    return fmt::format("{},{},{}", rgb >> 16U & 255U, rgb >> 8U & 255U, rgb & 255U);
}

std::string class_colour_hex(const ClassTable& classes, std::size_t index) {
    return fmt::format("#{:06x}", rgb_of(classes, index));
}

} // namespace macadam
