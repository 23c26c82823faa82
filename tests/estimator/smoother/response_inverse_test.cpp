#include "estimator/smoother/response_inverse.hpp"

#include "estimator/smoother/smoothed_iri.hpp"
#include "worlds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace macadam::testing {
namespace {

constexpr double step_s = 0.02;

/// Second order: 1 / (1 + sqrt(2) s + s^2), s in corners.
std::complex<double> second_order(double hz, double corner_hz) {
    const std::complex<double> s{0, hz / corner_hz};
    return 1.0 / (1.0 + std::numbers::sqrt2 * s + s * s);
}

std::vector<double> waves(std::initializer_list<double> all_hz, double corner_hz) {
    std::vector<double> values(3000);
    for (const double hz : all_hz) {
        const auto passed =
            corner_hz > 0 ? second_order(hz, corner_hz) : std::complex<double>{1, 0};
        for (std::size_t k = 0; k < values.size(); ++k) {
            const double angle = 2 * std::numbers::pi * hz * step_s * static_cast<double>(k);
            values[k] += (passed * std::polar(1.0, angle)).imag();
        }
    }
    return values;
}

} // namespace

/// Wrapping and the ends leave 1 % in the middle.
TEST(LowpassOff, GivesBackWavesThatASecondOrderFilterTookDown) {
    const auto before = waves({0.7, 4.3, 11.1, 17.9}, 0);
    const auto back = inverse_lowpass(waves({0.7, 4.3, 11.1, 17.9}, 15), step_s, 15, 2);
    ASSERT_EQ(back.size(), before.size());
    for (std::size_t k = 300; k < 2700; ++k) {
        ASSERT_NEAR(back[k], before[k], 0.04) << k;
    }
}

TEST(LowpassOff, RaisesNothingMoreThanThreefold) {
    const auto raised = inverse_lowpass(waves({20}, 0), step_s, 4, 2);
    for (std::size_t k = 300; k < 2700; ++k) {
        ASSERT_LT(std::abs(raised[k]), 3.1) << k;
    }
}

TEST(LowpassOff, OfAFarCornerChangesNothing) {
    const auto before = waves({1, 9}, 0);
    const auto after = inverse_lowpass(before, step_s, 1e5, 2);
    ASSERT_FALSE(before.empty());
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t k = 0; k < before.size(); ++k) {
        ASSERT_NEAR(after[k], before[k], 1e-3) << k;
    }
}

/// A corner of 12 Hz hides wheel hop and late readings put the road where it is not; stated in the
/// vehicle file, neither costs more than some percent.
TEST(LowpassOff, OfASensorsStatedLowpassGivesTheRoadAsIfThereWereNone) {
    auto recipe = drive_in(worlds()[3], 80);
    recipe.length_m = 800;
    const auto bias = [&](double lowpass_hz, double stated_hz) {
        recipe.imu.lowpass_hz = lowpass_hz;
        auto car = recipe.car.vehicle;
        car.half_car.friction_n = 0; // stated, so that the car is not tuned for it
        car.imu.lowpass_hz = stated_hz;
        const auto [stretch, truth] = driven_road(recipe);
        EstimatorConfig config{.method = Method::smoother, .channels = Channels::vertical};
        const auto run = smoothed_iri(stretch, TunedCar{.vehicle = car}, config);
        return errors_of(held_beside(run, truth, Index::hri, 40, car)).bias;
    };
    const double none = bias(0, 0);
    EXPECT_NEAR(bias(12, 12), none, 0.04);
    EXPECT_GT(std::abs(bias(12, 0) - none), 0.08);
}

} // namespace macadam::testing
