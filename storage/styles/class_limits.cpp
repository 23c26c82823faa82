#include "storage/styles/class_limits.hpp"

#include "mapping/style/class_colours.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

std::uint32_t rgb_of(const ClassTable& classes, std::size_t index) {
    return class_rgb(index, classes.classes.size());
}

} // namespace

double lower_limit(const ClassTable& classes, std::size_t index) {
    return index == 0 ? 0 : classes.classes[index - 1].to_mm_per_m;
}

std::string class_label(const ClassTable& classes, std::size_t index) {
    const auto& [name, to_mm_per_m, open] = classes.classes[index];
    const auto limits =
        classes.classes.size() == 1 ? std::string{"all"}
        : index == 0                ? fmt::format("below {:.2f} mm/m", to_mm_per_m)
        : index + 1 == classes.classes.size()
            ? fmt::format("above {:.2f} mm/m", lower_limit(classes, index))
            : fmt::format("{:.2f} to {:.2f} mm/m", lower_limit(classes, index), to_mm_per_m);
    return fmt::format("{} ({})", name, limits);
}

std::string class_colour_numbers(const ClassTable& classes, std::size_t index) {
    const auto rgb = rgb_of(classes, index);
    return fmt::format("{},{},{}", rgb >> 16U & 255U, rgb >> 8U & 255U, rgb & 255U);
}

std::string class_colour_hex(const ClassTable& classes, std::size_t index) {
    return fmt::format("#{:06x}", rgb_of(classes, index));
}

} // namespace macadam
