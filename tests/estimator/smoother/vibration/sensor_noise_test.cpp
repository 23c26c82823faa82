#include "estimator/smoother/vibration/sensor_noise.hpp"

#include "estimator/smoother/worlds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace macadam::testing {
namespace {

constexpr double stated_mps2 = 0.05;

/// What is found in two kilometres of a world by a sensor with this noise.
double found_mps2(const World& world, double true_mps2) {
    auto recipe = drive_in(world, 70);
    recipe.length_m = 2000;
    recipe.imu.noise_mps2 = true_mps2;
    VibrationSpectra spectra;
    add(spectra, driven_road(recipe).stretch);
    return sensor_noise_mps2(spectra, stated_mps2);
}

/// Windows of a drive in which the road's part of the power at high frequencies is that at lower
/// ones, times `ratio` and a scatter, and the sensor's noise the same everywhere.
VibrationSpectra
windows(double noise_mps2, double smoothest, double roughest, double ratio, int count) {
    VibrationSpectra spectra;
    std::mt19937 random{5};
    std::normal_distribution<double> scatter;
    for (int i = 0; i < count; ++i) {
        const double low = smoothest * std::pow(roughest / smoothest, i / (count - 1.0));
        const double looks = 14;
        const double high =
            (noise_mps2 * noise_mps2 + ratio * low * std::exp(0.3 * scatter(random))) *
            (1 + scatter(random) / std::sqrt(looks));
        spectra.windows.push_back({.log_speed = std::log(20) + 0.1 * scatter(random),
                                   .low = low,
                                   .high = std::max(high, 1e-9),
                                   .looks = looks});
    }
    return spectra;
}

} // namespace

TEST(SensorNoise, IsTheSameOnSmoothAndOnRoughRoads) {
    for (const double noise : {0.06, 0.1, 0.2}) {
        for (const double ratio : {0.04, 0.1, 0.25}) {
            const auto found =
                sensor_noise_mps2(windows(noise, 0.0025, 0.75, ratio, 120), stated_mps2);
            EXPECT_NEAR(found / noise, 1, 0.1) << noise << ' ' << ratio;
        }
    }
}

/// Stated is what a file says or what is usual: a quieter sensor does no harm.
TEST(SensorNoise, IsNeverLessThanStated) {
    EXPECT_EQ(sensor_noise_mps2(windows(0.02, 0.0025, 0.75, 0.1, 120), stated_mps2), stated_mps2);
}

TEST(SensorNoise, IsWhatIsStatedWhereNothingWasDriven) {
    EXPECT_EQ(sensor_noise_mps2({}, stated_mps2), stated_mps2);
    EXPECT_EQ(sensor_noise_mps2(windows(0.2, 0.0025, 0.75, 0.1, 11), stated_mps2), stated_mps2);
    EXPECT_EQ(sensor_noise_mps2(windows(0.2, 0.0025, 0.75, 0.1, 120), 0), 0);
    auto still = windows(0.2, 0.0025, 0.75, 0.1, 120);
    for (auto& window : still.windows) {
        window.high = 0;
    }
    EXPECT_EQ(sensor_noise_mps2(still, stated_mps2), stated_mps2);
}

/// Two kilometres of one roughness hardly tell the sensor's part from the road's: some of the noise
/// is found, and none that is not there.
TEST(SensorNoise, OfASimulatedDriveLiesBetweenWhatIsStatedAndWhatIsTrue) {
    ASSERT_GE(worlds().size(), 6U);
    double usual = 0;
    double noisy = 0;
    for (const auto& world : worlds()) {
        usual += found_mps2(world, stated_mps2) / static_cast<double>(worlds().size());
        const double found = found_mps2(world, 2 * stated_mps2);
        EXPECT_GE(found, 1.1 * stated_mps2) << world.name;
        EXPECT_LE(found, 2.1 * stated_mps2) << world.name;
        noisy += found / static_cast<double>(worlds().size());
    }
    EXPECT_LT(usual, 1.2 * stated_mps2);
    EXPECT_GT(noisy, 1.4 * stated_mps2);
}

} // namespace macadam::testing
