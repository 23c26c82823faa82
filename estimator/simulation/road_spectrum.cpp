#include "estimator/simulation/road_spectrum.hpp"

#include "estimator/iri/iri.hpp"
#include "estimator/simulation/road_features.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <span>

namespace macadam {

namespace {

using std::numbers::pi;

constexpr double longest_wave_m = 200; // longer waves have at most half the power
constexpr double bent_from_per_m = 0.005;
constexpr double bent_to_per_m = 5;

// The golden car per unit of sprung mass, ASTM E1926: tyre, suspension, damper, unsprung mass.
constexpr double k1 = 653;
constexpr double k2 = 63.3;
constexpr double c = 6;
constexpr double mu = 0.15;

/// |1 - a exp(-i w)|^2
double power(double a, double cos_w) {
    return 1 - 2 * a * cos_w + a * a;
}

/// Returns the power gain of the golden car from road slope to stroke per metre.
double golden_power(double waves_per_m) {
    const double w = 2 * pi * waves_per_m * golden_speed_mps;
    const double w2 = w * w;
    const double re = (k1 - mu * w2) * (k2 - w2) - w2 * k2;
    const double im = c * w * (k1 - mu * w2 - w2);
    return w2 * w2 * k1 * k1 / (re * re + im * im);
}

using GoldenState = std::array<double, 4>; // body, its rate, wheel, its rate; in slope units

GoldenState rate_of(const GoldenState& z, double slope) {
    const double force = k2 * (z[2] - z[0]) + c * (z[3] - z[1]);
    return {z[1], force, z[3], (k1 * (slope - z[2]) - force) / mu};
}

GoldenState plus(const GoldenState& z, double factor, const GoldenState& rate) {
    GoldenState sum = z;
    for (std::size_t i = 0; i < sum.size(); ++i) {
        sum[i] += factor * rate[i];
    }
    return sum;
}

GoldenState stepped(const GoldenState& z, double slope, double dt_s) {
    const auto a = rate_of(z, slope);
    const auto b = rate_of(plus(z, dt_s / 2, a), slope);
    const auto d = rate_of(plus(z, dt_s / 2, b), slope);
    const auto e = rate_of(plus(z, dt_s, d), slope);
    return plus(plus(z, dt_s / 6, plus(a, 2, b)), dt_s / 6, plus(e, 2, d));
}

constexpr double trial_step_m = 0.05;

/// Returns the stroke per metre over and after a shape of given length and height 1 m.
std::vector<double> trial(double length_m, const std::function<double(double)>& height) {
    constexpr double before_m = 1;
    constexpr double after_m = 50; // 2.2 s: the golden car is at rest again
    const auto count = static_cast<std::size_t>((before_m + length_m + after_m) / trial_step_m);
    std::vector<double> elevation_m(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double at_m = static_cast<double>(i) * trial_step_m - before_m;
        elevation_m[i] = at_m < 0 || at_m > length_m ? 0 : height(at_m);
    }
    return golden_stroke(elevation_m, trial_step_m);
}

double energy_m(const std::vector<double>& stroke) {
    double sum = 0;
    for (const double s : stroke) {
        sum += s * s;
    }
    return sum * trial_step_m;
}

/// Returns the contribution of a rare event to the mean stroke of a road of stroke sd `sd`, in
/// metres of road: the mean magnitude of a normal number shifted by s is about sqrt(s^2 + 2/pi
/// sd^2).
double added_m(const std::vector<double>& stroke, double size, double sd) {
    double sum = 0;
    const double square = 2 / pi * sd * sd;
    const double mean = std::sqrt(square);
    for (const double s : stroke) {
        sum += std::sqrt(size * size * s * s + square) - mean;
    }
    return sum * trial_step_m;
}

/// Contributions of single patches and potholes to the stroke of a road.
struct Events {
    std::vector<double> patch_stroke, pothole_stroke;
    double patches_per_m, potholes_per_m; ///< in one wheel path
    double pothole_depth_m;

    double added_iri(double sd) const {
        return patches_per_m * added_m(patch_stroke, patch_height_m, sd) +
               potholes_per_m * added_m(pothole_stroke, pothole_depth_m, sd);
    }
};

Events events_of(const RoadRecipe& recipe) {
    Events events{};
    events.patches_per_m = recipe.patches_per_km / 1000 * (0.5 + 0.5 * patch_in_both_tracks);
    events.potholes_per_m = recipe.potholes_per_km / 1000 / 2;
    if (recipe.patches_per_km > 0) {
        const double length_m = (min_patch_m + max_patch_m) / 2;
        events.patch_stroke = trial(length_m, [=](double at_m) { return patch(at_m, length_m); });
    }
    if (recipe.potholes_per_km > 0) {
        const double length_m = (min_pothole_m + max_pothole_m) / 2;
        events.pothole_stroke =
            trial(length_m, [=](double at_m) { return pothole(at_m, length_m); });
        const double half_off_path_m = pothole_off_path_m / 2;
        events.pothole_depth_m =
            (min_pothole_depth_m + max_pothole_depth_m) / 2 *
            pothole(pothole_half_width_m - half_off_path_m, 2 * pothole_half_width_m);
    }
    return events;
}

/// Returns the variance of the stroke due to slabs: their draws are independent, so their energies
/// add.
double slab_variance(const RoadRecipe& recipe) {
    if (recipe.joint_spacing_m <= 0) {
        return 0;
    }
    const double l = recipe.joint_spacing_m;
    const double energy = energy_m(trial(l, [=](double at_m) { return faulted_slab(at_m / l); })) +
                          energy_m(trial(l, [=](double at_m) { return curled_slab(at_m / l); }));
    const double size_m = recipe.joint_step_mm / 1000;
    return size_m * size_m * energy / l;
}

/// Solves for the argument between 0 and `most` at which an increasing function equals `aim`.
double solved(const std::function<double(double)>& rising, double aim, double most) {
    double low = 0;
    double high = most;
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        (rising(middle) < aim ? low : high) = middle;
    }
    return (low + high) / 2;
}

/// Steepness of the amplitude, beyond that of waviness 2, at each pole-zero pair.
using Steepness = std::array<double, RoadFilter::pair_count>;

/// Source: A. Oustaloup et al., "Frequency-band complex noninteger differentiator: characterization
/// and synthesis", IEEE Transactions on Circuits and Systems I 47 (2000), pp. 25-39.
RoadFilter filter_of(const Steepness& steepness, double step_m) {
    RoadFilter filter{};
    filter.step_m = step_m;
    filter.leak = std::exp(-2 * pi * step_m / longest_wave_m);
    const double ratio = std::pow(bent_to_per_m / bent_from_per_m, 1.0 / RoadFilter::pair_count);
    for (std::size_t i = 0; i < steepness.size(); ++i) {
        const auto at = [&](double shift) {
            return std::exp(-2 * pi * step_m * bent_from_per_m *
                            std::pow(ratio, static_cast<double>(i) + 0.5 + shift));
        };
        filter.pole[i] = at(-steepness[i] / 2);
        filter.zero[i] = at(steepness[i] / 2);
    }
    return filter;
}

/// Returns the mean spectral density of slope, in m, over the octave from a wavelength upwards.
double mean_slope_density_m(const RoadFilter& filter, double shortest_wave_m) {
    constexpr int points = 16;
    double sum = 0;
    for (int i = 0; i < points; ++i) {
        const double n = (1 + (i + 0.5) / points) / (2 * shortest_wave_m);
        sum += 4 * pi * pi * n * n * density_m3(filter, n);
    }
    return sum / points;
}

/// Octave whose level relative to that of 4 to 8 m is stated, and the pairs that set it.
struct BentOctave {
    double shortest_wave_m;
    std::size_t first_pair, second_pair;
    std::optional<double> ratio;
};

/// Changes the steepness of pairs until the stated ratios hold.
RoadFilter bent_filter(Steepness steepness, std::span<const BentOctave> octaves, double step_m) {
    constexpr double middle_m = 4;
    constexpr int rounds = 60; // 10 suffice but at the limits of both ratios
    RoadFilter filter = filter_of(steepness, step_m);
    for (int round = 0; round < rounds; ++round) {
        const double middle = mean_slope_density_m(filter, middle_m);
        for (const auto& octave : octaves) {
            if (octave.ratio) {
                const double wave = octave.shortest_wave_m;
                const double now = mean_slope_density_m(filter, wave) / middle;
                const double by = std::log(*octave.ratio / now) / (2 * std::log(wave / middle_m));
                steepness[octave.first_pair] += by;
                steepness[octave.second_pair] += by;
            }
        }
        filter = filter_of(steepness, step_m);
    }
    return filter;
}

} // namespace

RoadFilter road_filter(const RoadRecipe& recipe, double step_m) {
    Steepness steepness{};
    steepness.fill((recipe.waviness - 2) / 2);
    if (!recipe.long_wave_ratio && !recipe.short_wave_ratio) {
        return filter_of(steepness, step_m);
    }
    const std::array octaves{
        BentOctave{15, 1, 2, recipe.long_wave_ratio}, // waves of 63 to 6.3 m
        BentOctave{1, 3, 4, recipe.short_wave_ratio}, // waves of 6.3 to 0.63 m
    };
    return bent_filter(steepness, octaves, step_m);
}

double density_m3(const RoadFilter& filter, double waves_per_m) {
    const double cos_w = std::cos(2 * pi * waves_per_m * filter.step_m);
    double gain = 1 / power(filter.leak, cos_w);
    for (std::size_t i = 0; i < filter.pole.size(); ++i) {
        gain *= power(filter.zero[i], cos_w) / power(filter.pole[i], cos_w);
    }
    return 2 * filter.step_m * gain;
}

double golden_stroke_sd(const RoadFilter& filter) {
    constexpr int points = 400;
    constexpr double from_per_m = 0.002;
    const double to_per_m = 0.5 / filter.step_m;
    const double ratio = std::pow(to_per_m / from_per_m, 1.0 / points);
    double sum = 0;
    double n = from_per_m;
    for (int i = 0; i <= points; ++i) {
        const double slope = 2 * std::sin(pi * n * contact_patch_m) / contact_patch_m;
        const double weight = i == 0 || i == points ? 0.5 : 1; // trapezoidal rule over log n
        sum += weight * n * density_m3(filter, n) * slope * slope * golden_power(n);
        n *= ratio;
    }
    return std::sqrt(sum * std::log(ratio));
}

std::vector<double> golden_stroke(std::span<const double> elevation_m, double step_m) {
    const auto base = static_cast<std::size_t>(std::max(1.0, contact_patch_m / step_m + 0.5));
    std::vector<double> stroke;
    GoldenState z{};
    for (std::size_t i = 0; i + base < elevation_m.size(); ++i) {
        const double slope =
            (elevation_m[i + base] - elevation_m[i]) / (static_cast<double>(base) * step_m);
        z = stepped(z, slope, step_m / golden_speed_mps);
        stroke.push_back(z[0] - z[2]);
    }
    return stroke;
}

double noise_sd_m(const RoadRecipe& recipe, const RoadFilter& filter) {
    const double aim = recipe.iri_mm_per_m / 1000;
    const double slabs = slab_variance(recipe);
    const Events events = events_of(recipe);
    const double mean_of_sd = std::sqrt(2 / pi); // mean magnitude of a normal number
    const auto expected = [&](double sd) {
        const double both = std::sqrt(sd * sd + slabs);
        return mean_of_sd * both + events.added_iri(both);
    };
    const double alone = aim / mean_of_sd;
    const double sd = std::max(solved(expected, aim, alone), alone / 3);
    return sd / golden_stroke_sd(filter);
}

} // namespace macadam
