#include "render/scene/scale_bar.hpp"

#include <fmt/format.h>

#include <cmath>

namespace macadam {
namespace {

constexpr double metres_per_mile = 1609.344;
constexpr double metres_per_foot = 0.3048;

/// Returns the largest of 1, 2 and 5 times a power of ten that does not exceed `most`.
double round_below(double most) {
    const double power = std::pow(10.0, std::floor(std::log10(most)));
    for (const double digit : {5.0, 2.0}) {
        if (digit * power <= most) {
            return digit * power;
        }
    }
    return power;
}

} // namespace

ScaleBar scale_bar(double metres_per_px, double room_px, bool miles) {
    const double room_m = metres_per_px * room_px;
    const double large_m = miles ? metres_per_mile : 1000;
    const double small_m = miles ? metres_per_foot : 1;
    // Half a mile is easier to read than 2000 ft.
    const bool large = room_m >= (miles ? large_m / 2 : large_m);
    const double unit_m = large ? large_m : small_m;
    const double count = round_below(room_m / unit_m);
    const char* const name = large ? (miles ? "mi" : "km") : (miles ? "ft" : "m");
    return {.length_m = count * unit_m,
            .width_px = count * unit_m / metres_per_px,
            .label = fmt::format("{:g} {}", count, name)};
}

} // namespace macadam
