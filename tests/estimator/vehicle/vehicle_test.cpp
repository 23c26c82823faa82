#include "estimator/vehicle/vehicle.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace macadam::testing {
namespace {

TEST(Vehicles, AreFoundByName) {
    ASSERT_NE(built_in_vehicle("audi-a6-etron"), nullptr);
    EXPECT_EQ(built_in_vehicle("audi-a6-etron")->half_car.ks_n_per_m, 37050);
    EXPECT_EQ(built_in_vehicle("audi-a6-etron")->gain, 0.72);
    EXPECT_EQ(built_in_vehicle("trabant"), nullptr);
}

TEST(Vehicles, GoldenIsTheStandardsPerKilogram) {
    const auto& car = built_in_vehicle("golden-car")->half_car;
    EXPECT_DOUBLE_EQ(car.kt_n_per_m / (car.ms_kg / 4), 653);
    EXPECT_DOUBLE_EQ(car.ks_n_per_m / (car.ms_kg / 4), 63.3);
    EXPECT_DOUBLE_EQ(car.cs_ns_per_m / (car.ms_kg / 4), 6);
    EXPECT_DOUBLE_EQ(car.mu_kg / (car.ms_kg / 4), 0.15);
}

/// What the comment on the classes promises.
TEST(Vehicles, OfAClassBounceAndHopAsCarsDo) {
    int classes = 0;
    for (const auto& vehicle : built_in_vehicles()) {
        if (!vehicle.uncertainty.contains("ks_n_per_m")) {
            continue;
        }
        ++classes;
        const auto& car = vehicle.half_car;
        const double quarter_kg = car.ms_kg / 4;
        const double bounce = std::sqrt(car.ks_n_per_m / quarter_kg);
        const double hop = std::sqrt((car.ks_n_per_m + car.kt_n_per_m) / car.mu_kg);
        const double damping = car.cs_ns_per_m / (2 * quarter_kg * bounce);
        EXPECT_GT(bounce / (2 * std::numbers::pi), 1.2) << vehicle.name;
        EXPECT_LT(bounce / (2 * std::numbers::pi), 1.4) << vehicle.name;
        EXPECT_GT(damping, 0.25) << vehicle.name;
        EXPECT_LT(damping, 0.35) << vehicle.name;
        EXPECT_GT(hop / (2 * std::numbers::pi), 10) << vehicle.name;
        EXPECT_LT(hop / (2 * std::numbers::pi), 12.5) << vehicle.name;
    }
    EXPECT_GT(classes, 0);
}

} // namespace
} // namespace macadam::testing
