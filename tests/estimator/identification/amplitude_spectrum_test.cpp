#include "estimator/identification/amplitude_spectrum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace macadam::testing {
namespace {

constexpr double step_s = 0.01;
constexpr Band band{.from_hz = 0.5, .to_hz = 15, .smoothing_hz = 0.5};

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// A sample variance of 1 every 0.01 s is a one-sided density of 0.02 /Hz; the mean magnitude of
/// its transform is sqrt(pi) / 2 of the root of that.
TEST(AmplitudeSpectrum, OfWhiteNoiseIsTheRootOfItsDensity) {
    std::mt19937 random{4};
    std::normal_distribution<double> value{0, 1};
    std::vector<double> noise(20'000);
    std::ranges::generate(noise, [&] { return value(random); });
    const auto spectrum = amplitude_spectrum(noise, step_s, band);
    const double expected = std::sqrt(0.02) * std::sqrt(std::numbers::pi) / 2;
    EXPECT_NEAR(mean_of(spectrum.amplitude), expected, 0.02 * expected); // 2900 bins: 1 % expected
}

TEST(AmplitudeSpectrum, OfASineStandsAtItsFrequency) {
    std::vector<double> sine(3000);
    for (std::size_t i = 0; i < sine.size(); ++i) {
        sine[i] = std::sin(2 * std::numbers::pi * 6.3 * step_s * static_cast<double>(i));
    }
    const auto spectrum = amplitude_spectrum(sine, step_s, {0.5, 15, 0.02});
    const auto peak = std::ranges::max_element(spectrum.amplitude) - spectrum.amplitude.begin();
    EXPECT_NEAR(spectrum.hz[static_cast<std::size_t>(peak)], 6.3, 0.03); // a bin is 0.024 Hz
}

TEST(AmplitudeSpectrum, CoversTheBandAndNoMore) {
    const auto spectrum = amplitude_spectrum(std::vector<double>(3000, 1), step_s, band);
    EXPECT_GE(spectrum.hz.front(), 0.5);
    EXPECT_LT(spectrum.hz.front(), 0.53);
    EXPECT_LE(spectrum.hz.back(), 15);
    EXPECT_GT(spectrum.hz.back(), 14.97);
    EXPECT_EQ(spectrum.hz.size(), spectrum.amplitude.size());
}

/// What a turn or a slope adds below the band must not leak into it: under the Hann window it falls
/// with the cube of frequency.
TEST(AmplitudeSpectrum, KeepsSlowForcesOutOfTheBand) {
    std::vector<double> slow(3000);
    for (std::size_t i = 0; i < slow.size(); ++i) {
        slow[i] = std::cos(2 * std::numbers::pi * 0.05 * step_s * static_cast<double>(i));
    }
    const auto spectrum = amplitude_spectrum(slow, step_s, {1.0, 15, 0.5});
    EXPECT_LT(std::ranges::max(spectrum.amplitude), 1e-3); // of an amplitude of 1
}

TEST(AmplitudeSpectrum, GrowsWithTheSignal) {
    std::mt19937 random{4};
    std::normal_distribution<double> value{0, 1};
    std::vector<double> once(2000), thrice;
    std::ranges::generate(once, [&] { return value(random); });
    std::ranges::transform(once, std::back_inserter(thrice), [](double x) { return 3 * x; });
    const auto a = amplitude_spectrum(once, step_s, band);
    const auto b = amplitude_spectrum(thrice, step_s, band);
    ASSERT_FALSE(a.hz.empty());
    ASSERT_EQ(b.amplitude.size(), a.hz.size());
    for (std::size_t i = 0; i < a.hz.size(); ++i) {
        ASSERT_NEAR(b.amplitude[i], 3 * a.amplitude[i], 1e-12);
    }
}

} // namespace
} // namespace macadam::testing
