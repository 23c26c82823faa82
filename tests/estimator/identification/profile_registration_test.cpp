#include "estimator/identification/profile_registration.hpp"

#include "estimator/simulation/linear_ride.hpp"
#include "rides.hpp"

#include <gtest/gtest.h>

namespace macadam::testing {
namespace {

TEST(ProfileRegistration, IsFoundByTheRoadAlone) {
    const auto& car = *built_in_vehicle("audi-a6-etron");
    const auto profile = rough_profile(900, 250, 5);
    RoadProfile driven = profile; // from 300 m into it on, as travel 0
    const std::size_t from = 6000;
    driven.left_m.erase(driven.left_m.begin(), driven.left_m.begin() + from);
    driven.right_m.erase(driven.right_m.begin(), driven.right_m.begin() + from);
    driven.station_m.resize(driven.left_m.size());
    const auto place = find_place(std::vector{one_axle_ride(car, driven, 15, 50)}, profile, car);
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->at_m, 550, 0.5); // two steps of its grid
    EXPECT_GT(place->correlation, 0.9);
    EXPECT_EQ(place->compared_m, 300);
}

/// What one axle feels of a road under two lies between them, and looks less like it.
TEST(ProfileRegistration, OfATwoAxleCarIsThatOfItsCentreOfGravity) {
    auto car = linear_car();
    car.vehicle.axles = Axles{.wheelbase_m = 2.9, .cg_to_front_m = 1.2};
    const auto surface = make_surface({.iri_mm_per_m = 4}, 600, 9);
    const auto ride = two_axle_ride(car, surface, steady_motion(15, 38), 50);
    const auto place = find_place(std::vector{ride}, profile_of(surface), car.vehicle);
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->at_m, 0, 0.5);
    EXPECT_GT(place->correlation, 0.8);
}

TEST(ProfileRegistration, OnAnotherRoadHasALowCorrelation) {
    const auto& car = *built_in_vehicle("audi-a6-etron");
    const auto ride = one_axle_ride(car, rough_profile(500, 0, 5), 15, 50);
    const auto place = find_place(std::vector{ride}, rough_profile(3000, 0, 77), car);
    ASSERT_TRUE(place);
    EXPECT_LT(place->correlation, 0.45);
}

TEST(ProfileRegistration, IsNotSoughtWithLessThanAHundredMetres) {
    const auto& car = *built_in_vehicle("audi-a6-etron");
    const auto profile = rough_profile(120, 0, 5);
    EXPECT_FALSE(find_place(std::vector{one_axle_ride(car, profile, 15, 50)}, profile, car));
    EXPECT_FALSE(find_place({}, rough_profile(500, 0, 5), car));
}

} // namespace
} // namespace macadam::testing
