#include "mapping/fusion/fleet/left_out_cars.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace macadam {
namespace {

constexpr std::uint32_t cars = 12, trips_of_car = 4, places = 300;

struct Drives {
    std::vector<FleetReading> readings;
    FleetTrips trips;
};

/// Cars that differ by 6 %, trips by 2 %, passes by 7 % and 0.05 mm/m; half of the places each.
Drives drives_of(unsigned seed) {
    std::mt19937 random{seed};
    std::normal_distribution<double> normal;
    Drives drives;
    std::vector<double> of_trip;
    for (std::uint32_t car = 0; car < cars; ++car) {
        const double gain = 1 + 0.06 * normal(random);
        for (std::uint32_t trip = 0; trip < trips_of_car; ++trip) {
            of_trip.push_back(gain + 0.02 * normal(random));
            drives.trips.car.push_back(car);
            drives.trips.utc_ms.emplace_back(0);
        }
    }
    for (std::uint32_t place = 0; place < places; ++place) {
        const double level_um = 800 + 250 * (place % 15);
        for (std::uint32_t trip = 0; trip < of_trip.size(); ++trip) {
            if (random() % 2 == 0) {
                const double read_um =
                    level_um * (of_trip[trip] + 0.07 * normal(random)) + 50 * normal(random);
                drives.readings.push_back(
                    {place, trip / trips_of_car, trip, std::max(1.0, read_um)});
            }
        }
    }
    return drives;
}

double coverage(const LeftOutReadings& left_out) {
    return static_cast<double>(left_out.held) / static_cast<double>(left_out.count);
}

TEST(LeftOutCars, AreInsideNineIntervalsOfTenIfTheComponentsAreRight) {
    LeftOutReadings all;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const auto drives = drives_of(seed);
        const auto fleet = calibrate_fleet(
            drives.readings, std::vector<std::optional<double>>(cars), FleetPrior{});
        const auto left_out = leave_cars_out(drives.readings, drives.trips, fleet, {});
        EXPECT_EQ(left_out.count, drives.readings.size()) << seed; // all cars share all places
        all.count += left_out.count;
        all.held += left_out.held;
    }
    // Of 240 cars, some a fifth of the variance is the passes': the share inside is known to 2 %.
    EXPECT_NEAR(coverage(all), 0.9, 0.03);
}

TEST(LeftOutCars, TellThatComponentsAreTooSmallOrTooLarge) {
    const auto drives = drives_of(1);
    auto fleet =
        calibrate_fleet(drives.readings, std::vector<std::optional<double>>(cars), FleetPrior{});
    fleet.car_sd = 0.2;
    EXPECT_GT(coverage(leave_cars_out(drives.readings, drives.trips, fleet, {})), 0.97);
    fleet.car_sd = fleet.trip_sd = 0.001;
    fleet.rest_sd = 0.03;
    EXPECT_LT(coverage(leave_cars_out(drives.readings, drives.trips, fleet, {})), 0.75);
}

TEST(LeftOutCars, AreNotPredictedFromTheirOwnPeriods) {
    auto drives = drives_of(2);
    std::erase_if(drives.readings, [](const FleetReading& reading) { return reading.car > 1; });
    for (auto& trip_car : drives.trips.car) {
        trip_car = 0; // both are periods of one car
    }
    const auto fleet =
        calibrate_fleet(drives.readings, std::vector<std::optional<double>>(2), FleetPrior{});
    ASSERT_TRUE(fleet.cars[0] && fleet.cars[1]);
    EXPECT_EQ(leave_cars_out(drives.readings, drives.trips, fleet, {}), LeftOutReadings{});
}

TEST(LeftOutCars, NeedTwoCalibratedCars) {
    const auto none = calibrate_fleet({}, {}, FleetPrior{});
    EXPECT_EQ(leave_cars_out({}, {}, none, {}), LeftOutReadings{});
    auto drives = drives_of(3);
    std::erase_if(drives.readings, [](const FleetReading& reading) { return reading.car > 0; });
    const auto one =
        calibrate_fleet(drives.readings, std::vector<std::optional<double>>(1), FleetPrior{});
    EXPECT_EQ(leave_cars_out(drives.readings, drives.trips, one, {}), LeftOutReadings{});
}

} // namespace
} // namespace macadam
