#include "estimator/identification/profile_response.hpp"

#include "rides.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace macadam::testing {
namespace {

const Vehicle& audi() {
    return *built_in_vehicle("audi-a6-etron");
}

/// Root mean square of the difference over that of `expected`, behind the first 3 s.
double relative_error(const std::vector<double>& found, const std::vector<double>& expected) {
    double off = 0;
    double size = 0;
    for (std::size_t i = 300; i < expected.size(); ++i) {
        off += std::pow(found[i] - expected[i], 2);
        size += std::pow(expected[i], 2);
    }
    return std::sqrt(off / size);
}

/// Runge-Kutta over the forces of a car with gain 1, on the same road.
TEST(ProfileResponse, MakesTheModelFeelWhatAnIndependentIntegrationFeels) {
    Vehicle car = audi();
    car.gain = 1;
    const auto profile = rough_profile(400, 50, 5);
    const auto ride = simulate_response(one_axle_ride(car, profile, 20, 100), profile, 50);
    ASSERT_TRUE(ride);
    const auto vertical = vertical_response(*ride, car.half_car);
    const auto lateral = lateral_response(*ride, car.half_car, 0);
    // 2.5 ms of straight road against the integration's 0.5 ms.
    EXPECT_LT(relative_error(vertical, ride->vertical_mps2), 0.02);
    EXPECT_LT(relative_error(lateral, ride->lateral_mps2), 0.02);
}

TEST(ProfileResponse, IsCutToTheStationsOfTheProfile) {
    const auto profile = rough_profile(200, 1000, 5);
    Stretch stretch{};
    stretch.step_s = 0.01;
    for (int i = 0; i < 4000; ++i) {
        stretch.travel_m.push_back(0.1 * i);
        stretch.vertical_mps2.push_back(static_cast<float>(i));
    }
    const auto ride = simulate_response(stretch, profile, 900);
    ASSERT_TRUE(ride);
    EXPECT_NEAR(ride->from_m, 1000, 0.11);
    EXPECT_NEAR(ride->to_m, 1200, 0.11);
    EXPECT_NEAR(ride->vertical_mps2.front(), 1000, 1.1);
    EXPECT_EQ(ride->left_m.size(),
              (ride->vertical_mps2.size() - 1) * static_cast<std::size_t>(ride->road_per_sample) +
                  1);
    EXPECT_TRUE(ride->lateral_mps2.empty());
}

TEST(ProfileResponse, IsNothingBesideTheProfile) {
    const auto profile = rough_profile(200, 1000, 5);
    Stretch stretch{};
    stretch.step_s = 0.01;
    stretch.travel_m = {0, 0.1, 0.2};
    stretch.vertical_mps2 = {0, 0, 0};
    EXPECT_FALSE(simulate_response(stretch, profile, 0));
    EXPECT_FALSE(simulate_response(stretch, profile, 2000));
}

} // namespace
} // namespace macadam::testing
