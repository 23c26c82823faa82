#include "estimator/simulation/road_surface.hpp"

#include "estimator/common/error.hpp"
#include "estimator/iri/iri.hpp"
#include "estimator/simulation/road_features.hpp"
#include "estimator/simulation/road_spectrum.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

namespace macadam::testing {
namespace {

using std::numbers::pi;

/// A road whose roughness is the same all along it.
RoadRecipe steady(double iri_mm_per_m) {
    RoadRecipe recipe;
    recipe.iri_mm_per_m = iri_mm_per_m;
    recipe.level_sd = 0;
    return recipe;
}

/// Next to nothing of its own, so that what is put on it shows.
RoadRecipe bare() {
    return steady(0.01);
}

double mri(const RoadSurface& surface) {
    const auto paths = wheel_paths(surface);
    return (iri_mm_per_m(paths.left_m, paths.step_m) + iri_mm_per_m(paths.right_m, paths.step_m)) /
           2;
}

double hri(const RoadSurface& surface) {
    auto paths = wheel_paths(surface);
    for (std::size_t i = 0; i < paths.left_m.size(); ++i) {
        paths.left_m[i] = (paths.left_m[i] + paths.right_m[i]) / 2;
    }
    return iri_mm_per_m(paths.left_m, paths.step_m);
}

/// Spectral densities of two slope profiles and between them at one wave number, averaged over
/// windows of 200 m (Welch, with Hann's window).
struct Spectrum {
    double left, right;
    std::complex<double> cross;
};

Spectrum slope_spectrum(const WheelPaths& paths, double waves_per_m) {
    const auto window = static_cast<std::size_t>(200 / paths.step_m);
    Spectrum sum{0, 0, 0};
    for (std::size_t from = 0; from + window < paths.left_m.size(); from += window / 2) {
        std::complex<double> left = 0;
        std::complex<double> right = 0;
        for (std::size_t i = 0; i < window; ++i) {
            const double at = static_cast<double>(i);
            const double hann = 1 - std::cos(2 * pi * at / static_cast<double>(window));
            const auto turn = std::polar(hann, -2 * pi * waves_per_m * at * paths.step_m);
            left += turn * (paths.left_m[from + i + 1] - paths.left_m[from + i]);
            right += turn * (paths.right_m[from + i + 1] - paths.right_m[from + i]);
        }
        sum.left += std::norm(left);
        sum.right += std::norm(right);
        sum.cross += left * std::conj(right);
    }
    return sum;
}

/// The same over a third of an octave, in bins of 1 / 200 m or few of them.
Spectrum band_spectrum(const WheelPaths& paths, double middle_per_m) {
    Spectrum sum{0, 0, 0};
    for (int i = -4; i <= 4; ++i) {
        const auto part = slope_spectrum(paths, middle_per_m * std::pow(2, i / 24.0));
        sum.left += part.left / 9;
        sum.right += part.right / 9;
        sum.cross += part.cross / 9.0;
    }
    return sum;
}

std::uint64_t hash(const RoadSurface& surface) {
    std::uint64_t sum = 14695981039346656037U; // FNV-1a over the bits of every elevation
    for (const auto& line : surface.elevation_m) {
        for (const float z : line) {
            sum = (sum ^ std::bit_cast<std::uint32_t>(z)) * 1099511628211U;
        }
    }
    return sum;
}

RoadRecipe everything() {
    RoadRecipe recipe;
    recipe.waviness = 2.3;
    recipe.joint_spacing_m = 5;
    recipe.patches_per_km = 50;
    recipe.potholes_per_km = 50;
    return recipe;
}

TEST(RoadSurface, IsTheSameBitsOnEveryMachine) {
    EXPECT_EQ(hash(make_surface(everything(), 100, 7)), 9413341367995567669U);
}

TEST(RoadSurface, OfAnotherSeedIsAnotherRoad) {
    const auto one = make_surface(steady(2), 500, 1);
    const auto other = make_surface(steady(2), 500, 2);
    double product = 0;
    double square = 0;
    for (std::size_t i = 1; i < one.elevation_m[2].size(); ++i) {
        const double a = static_cast<double>(one.elevation_m[2][i] - one.elevation_m[2][i - 1]);
        const double b = static_cast<double>(other.elevation_m[2][i] - other.elevation_m[2][i - 1]);
        product += a * b;
        square += a * a;
    }
    EXPECT_LT(std::abs(product), 0.05 * square); // 10,000 independent products: 1 % is one sd
}

/// Closed form: a road of waviness 2 and G(0.1 / m) = 16e-6 m^3 (ISO 8608, middle of class A) has
/// an IRI of 2.1726 mm/m.
TEST(RoadSpectrum, OfAnIsoRoadMeetsTheClosedFormOfItsIri) {
    const auto filter = road_filter(RoadRecipe{}, 0.05);
    const double sd_m = noise_sd_m(steady(2.1726), filter);
    EXPECT_NEAR(density_m3(filter, 0.1) * sd_m * sd_m, 16e-6, 0.01 * 16e-6);
}

TEST(RoadSpectrum, FallsWithTheWavinessAsked) {
    for (const double waviness : {1.5, 2.0, 2.5, 3.0}) {
        const auto filter = road_filter({.waviness = waviness}, 0.05);
        for (const double n : {0.02, 0.05, 0.1, 0.3, 1.0}) { // in octaves from 50 m to 0.5 m
            const double slope = std::log2(density_m3(filter, n) / density_m3(filter, 2 * n));
            EXPECT_NEAR(slope, waviness, 0.12)
                << n; // the ripple of six pairs, the ends of the band
        }
    }
}

/// Road whose spectrum bends, waves of 15 to 30 m and of 1 to 2 m relative to those of 4 to 8 m.
RoadRecipe bent(double long_wave_ratio, double short_wave_ratio) {
    RoadRecipe recipe = steady(2);
    recipe.long_wave_ratio = long_wave_ratio;
    recipe.short_wave_ratio = short_wave_ratio;
    return recipe;
}

/// Mean density of slope, up to a factor, over the octave from a wavelength upwards.
double octave_level(const std::function<double(double)>& slope_density, double wave_m, int points) {
    double sum = 0;
    for (int i = 0; i < points; ++i) {
        sum += slope_density((1 + (i + 0.5) / points) / (2 * wave_m)) / points;
    }
    return sum;
}

/// Levels of measured roads, and the limits of a recipe.
TEST(RoadSpectrum, BendsToTheStatedOctaves) {
    constexpr double levels[][2] = {
        {1.6, 0.40}, {7.8, 0.24}, {0.42, 0.76}, {1, 1}, {0.2, 0.2}, {0.2, 8}, {8, 0.2}, {8, 8}};
    for (const auto& [long_waves, short_waves] : levels) {
        for (const double waviness : {1.2, 2.0, 3.2}) {
            auto recipe = bent(long_waves, short_waves);
            recipe.waviness = waviness;
            const auto filter = road_filter(recipe, 0.05);
            const auto slope = [&](double n) { return n * n * density_m3(filter, n); };
            const double middle = octave_level(slope, 4, 500);
            const double long_level = octave_level(slope, 15, 500) / middle;
            const double short_level = octave_level(slope, 1, 500) / middle;
            EXPECT_NEAR(long_level / long_waves, 1, 0.01) << long_waves << ' ' << short_waves;
            EXPECT_NEAR(short_level / short_waves, 1, 0.01) << long_waves << ' ' << short_waves;
        }
    }
}

TEST(RoadSpectrum, BendsOnlyWhereTheRecipeSays) {
    RoadRecipe recipe = steady(2);
    recipe.short_wave_ratio = 0.3;
    const auto filter = road_filter(recipe, 0.05);
    const auto straight = road_filter(steady(2), 0.05);
    for (const double n : {0.02, 0.05, 2.5, 5.0}) { // the waviness is 2: slopes are level
        const double step = density_m3(filter, n) / density_m3(filter, 1.25 * n);
        EXPECT_NEAR(step * density_m3(straight, 1.25 * n) / density_m3(straight, n), 1, 0.12) << n;
    }
}

TEST(RoadSpectrum, GoldenStrokeIsThatOfTheReferenceIri) {
    const auto paths = wheel_paths(make_surface(steady(3), 200, 3));
    const auto stroke = golden_stroke(paths.left_m, paths.step_m);
    double sum = 0;
    for (const double s : stroke) {
        sum += std::abs(s);
    }
    const double ours = 1000 * sum / static_cast<double>(stroke.size());
    const double reference = iri_mm_per_m(paths.left_m, paths.step_m);
    EXPECT_NEAR(ours, reference, 0.01 * reference); // they start differently
}

/// What the filter says, measured on a road.
TEST(RoadSurface, HasTheSpectrumOfItsRecipe) {
    RoadRecipe recipe = steady(2);
    recipe.waviness = 2.6;
    const auto paths = wheel_paths(make_surface(recipe, 6000, 5));
    const auto at = [&](double n) {
        const auto spectrum = band_spectrum(paths, n);
        return (spectrum.left + spectrum.right) / 2;
    };
    const double from = at(0.05);
    const double to = at(1.6); // five octaves on; slopes fall with waviness - 2
    EXPECT_NEAR(std::log2(from / to) / 5, 0.6, 0.1); // 60 windows of few bins: 0.06 per octave
}

TEST(RoadSurface, HasTheOctavesOfItsRecipe) {
    const auto paths = wheel_paths(make_surface(bent(5, 0.3), 6000, 8));
    const auto slope = [&](double n) {
        const auto spectrum = slope_spectrum(paths, n);
        return spectrum.left + spectrum.right;
    };
    constexpr int points = 8;
    const double middle = octave_level(slope, 4, points);
    // 200 waves and more in 6 km, left and right alike in the long ones: 7 % is one sd.
    EXPECT_NEAR(octave_level(slope, 15, points) / middle, 5, 1);
    EXPECT_NEAR(octave_level(slope, 1, points) / middle, 0.3, 0.03);
}

TEST(RoadSurface, TracksAreAlikeInLongWavesOnly) {
    const auto paths = wheel_paths(make_surface(steady(2), 6000, 6));
    for (const double n : {0.03, 0.1, 0.33, 1.0, 2.0}) {
        const auto s = band_spectrum(paths, n);
        const double coherency = s.cross.real() / std::sqrt(s.left * s.right);
        EXPECT_NEAR(coherency, 1 / (1 + std::pow(3 * n, 2)), 0.08) << n;
    }
}

TEST(RoadSurface, MeanIriIsNearTheRecipes) {
    for (const double aim : {0.8, 2.0, 6.0}) {
        EXPECT_NEAR(mri(make_surface(steady(aim), 5000, 11)), aim, 0.02 * aim) << aim;
    }
}

TEST(RoadSurface, MeanIriIsNearTheRecipesWhateverTheWaviness) {
    for (const double waviness : {1.5, 3.0}) {
        RoadRecipe recipe = steady(2);
        recipe.waviness = waviness;
        EXPECT_NEAR(mri(make_surface(recipe, 5000, 12)), 2, 0.06) << waviness;
    }
}

TEST(RoadSurface, MeanIriIsNearTheRecipesHoweverTheSpectrumBends) {
    for (const auto& recipe : {bent(7.8, 0.24), bent(0.42, 0.76)}) {
        EXPECT_NEAR(mri(make_surface(recipe, 5000, 12)), 2, 0.08) << *recipe.long_wave_ratio;
    }
}

TEST(RoadSurface, MeanIriCountsSlabsPatchesAndPotholes) {
    RoadRecipe slabs = steady(2);
    slabs.joint_spacing_m = 5;
    slabs.joint_step_mm = 2;
    RoadRecipe patches = steady(3);
    patches.patches_per_km = 20;
    RoadRecipe potholes = steady(4);
    potholes.potholes_per_km = 15;
    for (const auto& recipe : {slabs, patches, potholes}) {
        const double aim = recipe.iri_mm_per_m;
        EXPECT_NEAR(mri(make_surface(recipe, 5000, 13)), aim, 0.08 * aim) << aim;
    }
}

TEST(RoadSurface, WhatDoesNotFitTheAimMakesTheRoadRougher) {
    RoadRecipe recipe = steady(1);
    recipe.potholes_per_km = 100;
    EXPECT_GT(mri(make_surface(recipe, 2000, 14)), 1.5);
}

/// MRI over HRI of measured roads lies between 1.04 and 1.18.
TEST(RoadSurface, MeanOfItsTracksIsAsMuchSmootherAsOnRealRoads) {
    const auto surface = make_surface(steady(2), 5000, 15);
    EXPECT_GT(mri(surface) / hri(surface), 1.04);
    EXPECT_LT(mri(surface) / hri(surface), 1.18);
}

TEST(RoadSurface, LevelOfRoughnessChangesAlongTheRoad) {
    RoadRecipe recipe = steady(2);
    recipe.level_sd = 0.5;
    const auto spread = [](const RoadRecipe& of) {
        const auto paths = wheel_paths(make_surface(of, 5000, 16));
        const auto stroke = rectified_stroke_mm_per_m(paths.left_m, paths.step_m);
        const auto piece = static_cast<std::size_t>(100 / paths.step_m);
        double sum = 0;
        double square = 0;
        int count = 0;
        for (std::size_t from = 0; from + piece <= stroke.size(); from += piece, ++count) {
            double mean = 0;
            for (std::size_t i = 0; i < piece; ++i) {
                mean += static_cast<double>(stroke[from + i]) / static_cast<double>(piece);
            }
            sum += std::log(mean);
            square += std::pow(std::log(mean), 2);
        }
        return std::sqrt(square / count - std::pow(sum / count, 2));
    };
    EXPECT_LT(spread(steady(2)), 0.12);
    EXPECT_NEAR(spread(recipe), 0.45, 0.12); // 0.5, less what 100 m average
}

TEST(RoadSurface, AWheelBetweenTwoLinesFeelsARoadAsRough) {
    const auto surface = make_surface(steady(2), 5000, 17);
    std::vector<double> between_m;
    for (double at_m = 0; at_m < surface.length_m(); at_m += surface.step_m) {
        between_m.push_back(elevation_m(surface, at_m, 0.875));
    }
    EXPECT_NEAR(iri_mm_per_m(between_m, surface.step_m), 2, 0.04);
}

TEST(RoadSurface, ShortWavesChangeOverDecimetresAcross) {
    const auto surface = make_surface(steady(2), 2000, 18);
    const auto alike = [&](double apart_m) { // of slopes over 0.1 m
        double product = 0;
        double square = 0;
        for (double at_m = 1; at_m < surface.length_m() - 1; at_m += 0.1) {
            const auto slope = [&](double lateral_m) {
                return elevation_m(surface, at_m + 0.1, lateral_m) -
                       elevation_m(surface, at_m, lateral_m);
            };
            product += slope(0.75) * slope(0.75 - apart_m);
            square += slope(0.75) * slope(0.75);
        }
        return product / square;
    };
    EXPECT_GT(alike(0.1), 0.9);
    EXPECT_NEAR(alike(0.5), 0.5, 0.15); // exp(-(0.5 / 0.4)^2 / 2) and what is common
    EXPECT_LT(alike(1.5), 0.2);
}

TEST(RoadSurface, BeginsAndEndsAtZeroOnEveryLine) {
    for (const double length_m : {0.1, 1.234, 5.0, 61.7, 150.0, 1000.0}) {
        const auto surface = make_surface(everything(), length_m, 19);
        EXPECT_DOUBLE_EQ(surface.length_m(), length_m);
        for (const auto& line : surface.elevation_m) {
            EXPECT_EQ(line.front(), 0) << length_m;
            EXPECT_EQ(line.back(), 0) << length_m;
        }
    }
}

/// Over metres; over decimetres it is as rough there as anywhere.
TEST(RoadSurface, HasNoSlopeAtItsEnds) {
    double end_square = 0;
    double middle_square = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const auto surface = make_surface(steady(2), 200, seed);
        const auto slope = [&](double from_m) {
            return (elevation_m(surface, from_m + 5, 0.75) - elevation_m(surface, from_m, 0.75)) /
                   5;
        };
        end_square += std::pow(slope(0), 2) + std::pow(slope(195), 2);
        middle_square += std::pow(slope(60), 2) + std::pow(slope(135), 2);
    }
    EXPECT_LT(end_square, 0.05 * middle_square);
}

TEST(RoadSurface, IsAsRoughInItsLastMetresAsInItsMiddle) {
    const auto bend = [](const RoadSurface& surface, double at_m) {
        return elevation_m(surface, at_m - 0.25, 0.75) - 2 * elevation_m(surface, at_m, 0.75) +
               elevation_m(surface, at_m + 0.25, 0.75);
    };
    double end_square = 0;
    double middle_square = 0;
    for (std::uint64_t seed = 100; seed < 160; ++seed) {
        const auto surface = make_surface(steady(2), 100, seed);
        for (double at_m = 0.5; at_m < 5; at_m += 0.5) {
            end_square += std::pow(bend(surface, at_m), 2) + std::pow(bend(surface, 100 - at_m), 2);
            middle_square +=
                std::pow(bend(surface, 50 + at_m), 2) + std::pow(bend(surface, 50 - at_m), 2);
        }
    }
    EXPECT_NEAR(end_square / middle_square, 1, 0.15); // 540 pairs on each side: 6 % is one sd
}

TEST(RoadSurface, IsHeldBeyondItsBorders) {
    const auto surface = make_surface(steady(2), 20, 20);
    EXPECT_EQ(elevation_m(surface, -3, 0.75), 0);
    EXPECT_EQ(elevation_m(surface, 25, 0.75), 0);
    EXPECT_EQ(elevation_m(surface, 10, 5), elevation_m(surface, 10, 1.25));
}

TEST(RoadSurface, WheelPathsAreItsOwnLines) {
    const auto surface = make_surface(steady(2), 20, 21);
    const auto paths = wheel_paths(surface);
    EXPECT_EQ(paths.step_m, surface.step_m);
    for (std::size_t i = 0; i < paths.left_m.size(); ++i) {
        const double at_m = static_cast<double>(i) * surface.step_m;
        EXPECT_NEAR(paths.left_m[i], elevation_m(surface, at_m, 0.75), 1e-9);
        EXPECT_NEAR(paths.right_m[i], elevation_m(surface, at_m, -0.75), 1e-9);
    }
}

TEST(RoadSurface, SlabsStepAtTheirJoints) {
    RoadRecipe recipe = bare();
    recipe.joint_spacing_m = 5;
    recipe.joint_step_mm = 4;
    const auto paths = wheel_paths(make_surface(recipe, 5000, 22));
    double square = 0;
    std::vector<double> joints_m;
    for (std::size_t i = 1; i < paths.left_m.size(); ++i) {
        const double step_m = paths.left_m[i] - paths.left_m[i - 1];
        if (std::abs(step_m) > 0.001) { // a slab itself rises by 0.1 mm a station
            square += step_m * step_m;
            joints_m.push_back(static_cast<double>(i) * paths.step_m);
        }
    }
    EXPECT_NEAR(
        std::sqrt(square / 1000), 0.004, 0.0004); // of 1000 joints; the low ones add nothing
    for (const double at_m : joints_m) {
        EXPECT_NEAR(std::remainder(at_m - joints_m.front(), 5), 0, 0.051);
    }
}

TEST(RoadSurface, PotholesLieInOneTrackAndAreAsDeepAsStated) {
    RoadRecipe recipe = bare();
    recipe.potholes_per_km = 20;
    const auto surface = make_surface(recipe, 1000, 23);
    int deep = 0;
    for (double at_m = 0; at_m < 1000; at_m += 0.05) {
        const double left_m = elevation_m(surface, at_m, 0.75);
        const double right_m = elevation_m(surface, at_m, -0.75);
        EXPECT_GT(std::min(left_m, right_m), -0.065);
        deep += std::min(left_m, right_m) < -0.01 ? 1 : 0;
        EXPECT_TRUE(left_m > -0.005 || right_m > -0.005) << at_m; // never in both
    }
    EXPECT_GT(deep * 0.05, 20 * 0.1); // twenty of half a metre, half of each deep enough
    EXPECT_LT(deep * 0.05, 20 * 0.6);
}

TEST(RoadSurface, PatchesHaveAnEdgeAtBothEnds) {
    RoadRecipe recipe = bare();
    recipe.patches_per_km = 10;
    const auto paths = wheel_paths(make_surface(recipe, 2000, 24));
    int edges = 0;
    double on_m = 0;
    for (std::size_t i = 1; i < paths.left_m.size(); ++i) {
        const bool was = std::abs(paths.left_m[i - 1]) > 0.001;
        const bool is = std::abs(paths.left_m[i]) > 0.001;
        edges += was != is ? 1 : 0;
        on_m += is ? paths.step_m : 0;
    }
    EXPECT_EQ(edges % 2, 0);
    EXPECT_GT(edges, 2 * 7); // of 20, three quarters touch this track, a few are too low to see
    EXPECT_LT(edges, 2 * 20);
    EXPECT_NEAR(on_m / (edges / 2), 8, 3); // 1 to 15 m each
}

std::string refusal(const std::function<void()>& deed) {
    try {
        deed();
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

TEST(RoadSurface, RefusesALengthThatNoLaneHas) {
    EXPECT_EQ(refusal([] { make_surface(steady(2), 0, 1); }),
              "road: length in metres is 0, expected 0.1 to 200000");
    EXPECT_EQ(refusal([] { make_surface(steady(2), std::nan(""), 1); }),
              "road: length in metres is nan, expected 0.1 to 200000");
}

TEST(RoadSurface, RefusesARecipeOutOfItsRange) {
    RoadRecipe recipe = steady(2);
    recipe.waviness = 5;
    EXPECT_EQ(refusal([&] { make_surface(recipe, 10, 1); }),
              "road: waviness is 5, expected 1.2 to 3.2");
    EXPECT_EQ(refusal([&] { make_surface(bent(11, 1), 10, 1); }),
              "road: long_wave_ratio is 11, expected 0.2 to 8");
    EXPECT_EQ(refusal([&] { make_surface(bent(1, 0.05), 10, 1); }),
              "road: short_wave_ratio is 0.05, expected 0.2 to 8");
    recipe = steady(-1);
    EXPECT_EQ(refusal([&] { make_surface(recipe, 10, 1); }),
              "road: iri is -1, expected 0.01 to 50");
    recipe = steady(2);
    recipe.joint_spacing_m = 0.2;
    EXPECT_EQ(refusal([&] { make_surface(recipe, 10, 1); }),
              "road: joint_spacing_m is 0.2, expected 1 to 100");
}

} // namespace
} // namespace macadam::testing
