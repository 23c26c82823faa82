#include "estimator/identification/car_modes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace macadam::testing {
namespace {

/// A wheel of no mass to speak of: the body on spring and tyre in a row.
TEST(CarModes, OfALightWheelAreTheBodysOnSpringAndTyreInSeries) {
    const HalfCar car{.ms_kg = 1600,
                      .mu_kg = 0.5,
                      .ks_n_per_m = 30000,
                      .cs_ns_per_m = 1,
                      .kt_n_per_m = 250000,
                      .is_kgm2 = 350,
                      .l_m = 0.78};
    const double stiffness = 1 / (1 / 30000.0 + 1 / 250000.0);
    EXPECT_NEAR(modes_of(car).bounce_hz,
                std::sqrt(stiffness / 400) / (2 * std::numbers::pi),
                1e-3); // what 0.5 kg and a slight damper change
}

TEST(CarModes, OfAHeavyBodyHaveItsWheelOnBothSprings) {
    const HalfCar car{.ms_kg = 4e6,
                      .mu_kg = 45,
                      .ks_n_per_m = 30000,
                      .cs_ns_per_m = 500,
                      .kt_n_per_m = 250000,
                      .is_kgm2 = 350,
                      .l_m = 0.78};
    EXPECT_NEAR(modes_of(car).hop_hz, std::sqrt(280000 / 45.0) / (2 * std::numbers::pi), 0.01);
}

TEST(CarModes, OfTheGoldenCarAreThoseOfAPassengerCar) {
    const auto modes = modes_of(built_in_vehicle("golden-car")->half_car);
    EXPECT_NEAR(modes.bounce_hz, 1.2, 0.1);
    EXPECT_NEAR(modes.bounce_damping, 0.35, 0.1);
    EXPECT_NEAR(modes.hop_hz, 10.9, 0.5);
}

} // namespace
} // namespace macadam::testing
