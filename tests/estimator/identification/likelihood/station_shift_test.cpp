#include "estimator/identification/likelihood/station_shift.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace macadam::testing {
namespace {

constexpr double step_s = 0.02;
constexpr double pace_m = 0.3;

std::vector<double> stations(std::size_t count) {
    std::vector<double> station_m;
    for (std::size_t k = 0; k < count; ++k) {
        station_m.push_back(1000 + pace_m * static_cast<double>(k));
    }
    return station_m;
}

/// A signal along the road with waves of a car's vibration.
double signal_at(double station_m) {
    double sum = 0;
    for (int wave = 1; wave <= 40; ++wave) {
        sum += std::sin(station_m * (0.4 + 0.037 * wave) + wave * wave);
    }
    return sum;
}

void expect_shifts_found(std::size_t samples, std::size_t knot_count) {
    const auto station_m = stations(samples);
    const auto knots = knots_along(station_m);
    ASSERT_EQ(knots.count, knot_count);
    std::vector<double> measured, modelled;
    for (const double station : station_m) {
        const double shift_m = 2 - 0.008 * (station - 1000); // 2 m to -2.8 m
        measured.push_back(signal_at(station + shift_m));
        modelled.push_back(signal_at(station));
    }
    const auto shift_m = correlated_shifts(knots, station_m, measured, modelled, step_s);
    for (std::size_t knot = 1; knot + 1 < knots.count; ++knot) {
        EXPECT_NEAR(shift_m[knot], 2 - 0.4 * static_cast<double>(knot), 0.5) << knot;
    }
}

TEST(StationShift, IsFoundAlongADriveWhoseOdometerIsOff) {
    expect_shifts_found(2000, 13);
}

/// Of 500.7 and 502.2 m, the last knot sees only 0.7 and 2.2 m, which match anywhere.
TEST(StationShift, IsNotMisledByTheLastMetres) {
    expect_shifts_found(1670, 12);
    expect_shifts_found(1675, 12);
}

TEST(StationShift, IsLinearBetweenKnots) {
    const ShiftKnots knots{.first_m = 10, .count = 3};
    const std::vector<double> value_m{0, 1, 3};
    const std::vector<double> station_m{10, 35, 60, 85, 110};
    EXPECT_EQ(shifts_at(knots, value_m, station_m), (std::vector<double>{0, 0.5, 1, 2, 3}));
    EXPECT_EQ(share_of(knots, 1, 60), 1);
    EXPECT_EQ(share_of(knots, 1, 85), 0.5);
    EXPECT_EQ(share_of(knots, 1, 110), 0);
}

} // namespace
} // namespace macadam::testing
