#pragma once

#include "estimator/simulation/road_surface.hpp"

#include <array>
#include <span>
#include <vector>

namespace macadam {

/// Shapes white noise at stations of one step into a road: y = leak y[-1] + x, then pairs of a
/// pole and a zero, y = x - zero x[-1] + pole y[-1], evenly spread over the logarithm of wave
/// number, that bend the slope from 2 to the waviness.
struct RoadFilter {
    static constexpr int pair_count = 6;

    double step_m;
    double leak;
    std::array<double, pair_count> pole;
    std::array<double, pair_count> zero;
};

RoadFilter road_filter(double waviness, double step_m);

/// Spectral density of elevation, one-sided, in m^3, where the noise has variance 1 m^2.
double density_m3(const RoadFilter& filter, double waves_per_m);

/// Standard deviation of the golden car's stroke per metre travelled, for noise of variance 1.
double golden_stroke_sd(const RoadFilter& filter);

/// The golden car's stroke per metre along an elevation profile (ASTM E1926), signed.
std::vector<double> golden_stroke(std::span<const double> elevation_m, double step_m);

/// Standard deviation of the noise that makes the expected IRI of a wheel path that of the recipe.
double noise_sd_m(const RoadRecipe& recipe, const RoadFilter& filter);

} // namespace macadam
