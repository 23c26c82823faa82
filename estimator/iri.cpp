#include "estimator/iri.hpp"

#include "estimator/common/error.hpp"
#include "estimator/quarter_car.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

void check(std::span<const double> elevation_m, double step_m) {
    if (elevation_m.size() < 2) {
        throw InputError{
            fmt::format("profile has {} points, expected at least 2", elevation_m.size())};
    }
    if (!(step_m > 0 && step_m <= coarsest_step_m)) {
        throw InputError{
            fmt::format("profile step is {} m, expected 0 to {}", step_m, coarsest_step_m)};
    }
    const auto bad =
        std::ranges::find_if_not(elevation_m, [](double z) { return std::isfinite(z); });
    if (bad != elevation_m.end()) {
        throw InputError{fmt::format("profile elevation {} is '{}', expected a finite number",
                                     bad - elevation_m.begin(),
                                     *bad)};
    }
}

/// Whole steps nearest to a length, at least one, at most as many as there are.
std::size_t steps_in(double length_m, double step_m, std::size_t most) {
    const auto steps = static_cast<std::size_t>(std::floor(length_m / step_m + 0.5));
    return std::clamp<std::size_t>(steps, 1, most);
}

double mean_slope(std::span<const double> elevation_m, std::size_t steps, double step_m) {
    return (elevation_m[steps] - elevation_m[0]) / (static_cast<double>(steps) * step_m);
}

} // namespace

std::vector<float>
rectified_stroke_mm_per_m(std::span<const double> elevation_m, double step_m, bool envelope) {
    check(elevation_m, step_m);

    const std::size_t steps = elevation_m.size() - 1;
    const std::size_t patch = envelope ? steps_in(contact_patch_m, step_m, steps) : 1;
    const double start = mean_slope(elevation_m, steps_in(start_up_m, step_m, steps), step_m);

    const auto car = discretise(golden_car(), step_m / golden_speed_mps);
    Eigen::Vector4d state{start, 0, start, 0};
    std::vector<float> stroke(elevation_m.size() - patch);
    for (std::size_t i = 0; i < stroke.size(); ++i) {
        // The mean over the patch and the difference are one: the slope from its rear to its front.
        const double slope = mean_slope(elevation_m.subspan(i), patch, step_m);
        state = car.a * state + car.b * slope;
        stroke[i] = static_cast<float>(1000 * std::abs(state[0] - state[2]));
    }
    return stroke;
}

double iri_mm_per_m(std::span<const double> elevation_m, double step_m, bool envelope) {
    const auto stroke = rectified_stroke_mm_per_m(elevation_m, step_m, envelope);
    double sum = 0;
    for (const float value : stroke) {
        sum += static_cast<double>(value);
    }
    return sum / static_cast<double>(stroke.size());
}

} // namespace macadam
