#pragma once

#include "estimator/simulation/road_surface.hpp"

#include <array>
#include <span>
#include <vector>

namespace macadam {

/// Filter that shapes white noise at equidistant stations into a road: y = leak y[-1] + x, then
/// pole-zero pairs, y = x - zero x[-1] + pole y[-1], evenly spaced over the logarithm of wave
/// number, that change the slope from 2 to the waviness, or bend the spectrum.
struct RoadFilter {
    static constexpr int pair_count = 6;

    double step_m;
    double leak;
    std::array<double, pair_count> pole;
    std::array<double, pair_count> zero;
};

/// Returns the filter of a recipe's spectrum. Stated ratios bend it between waves of 63 and 0.63 m;
/// beyond, it falls with the waviness.
RoadFilter road_filter(const RoadRecipe& recipe, double step_m);

/// Returns the one-sided spectral density of elevation in m^3, for noise of variance 1 m^2.
double density_m3(const RoadFilter& filter, double waves_per_m);

/// Returns the standard deviation of the golden car's stroke per metre travelled, for noise of
/// variance 1.
double golden_stroke_sd(const RoadFilter& filter);

/// Computes the golden car's stroke per metre along an elevation profile (ASTM E1926), signed.
std::vector<double> golden_stroke(std::span<const double> elevation_m, double step_m);

/// Returns the standard deviation of the noise for which the expected IRI of a wheel path is that
/// of the recipe.
double noise_sd_m(const RoadRecipe& recipe, const RoadFilter& filter);

} // namespace macadam
