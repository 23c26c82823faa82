#include "mapping/fusion/fleet/changing_fleet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace macadam {
namespace {

constexpr std::int64_t begin_ms = 1'770'000'000'000;
constexpr std::int64_t day_ms = 86'400'000;

/// Cars that drive a trip every third day over parts of the same roads.
struct Fleet {
    std::uint32_t cars = 8;
    std::uint32_t trips_of_car = 20;
    std::uint32_t places = 600;
    std::uint32_t places_of_trip = 200; ///< consecutive
    double trip_sd = 0.02;
    double rest_sd = 0.07;

    /// Factors on what a car reads on a trip, and on its scatter.
    std::function<double(std::uint32_t car, std::uint32_t trip)> level = [](auto, auto) {
        return 1;
    };
    std::function<double(std::uint32_t car, std::uint32_t trip)> scatter = [](auto, auto) {
        return 1;
    };
    /// Factor on the road at a place on a day.
    std::function<double(std::uint32_t place, double day)> road = [](auto, auto) { return 1; };
};

struct Drives {
    std::vector<FleetReading> readings;
    FleetTrips trips;
};

double day_of(std::uint32_t car, std::uint32_t trip) {
    return 3.0 * trip + 0.3 * car;
}

Drives drives_of(const Fleet& fleet, unsigned seed) {
    std::mt19937 random{seed};
    std::normal_distribution<double> normal;
    Drives drives;
    for (std::uint32_t car = 0; car < fleet.cars; ++car) {
        const double gain = 1 + 0.06 * normal(random);
        for (std::uint32_t trip = 0; trip < fleet.trips_of_car; ++trip) {
            const auto number = static_cast<std::uint32_t>(drives.trips.car.size());
            const double day = day_of(car, trip);
            const double of_trip = gain * (1 + fleet.trip_sd * normal(random));
            const auto first = static_cast<std::uint32_t>(random() % fleet.places);
            for (std::uint32_t i = 0; i < fleet.places_of_trip; ++i) {
                const auto place = (first + i) % fleet.places;
                const double rest = 1 + fleet.rest_sd * fleet.scatter(car, trip) * normal(random);
                const double level_um = (1000 + 250 * (place % 13)) * fleet.road(place, day);
                drives.readings.push_back(
                    {.place = place,
                     .car = car,
                     .trip = number,
                     .read_um = std::max(
                         1.0, level_um * of_trip * fleet.level(car, trip) * std::max(0.05, rest))});
            }
            drives.trips.car.push_back(car);
            drives.trips.utc_ms.push_back(begin_ms + static_cast<std::int64_t>(day * day_ms));
        }
    }
    std::ranges::stable_sort(drives.readings, {}, &FleetReading::place);
    return drives;
}

ChangingFleet calibrated(const Fleet& fleet, const Drives& drives) {
    return calibrate_changing_fleet(
        drives.readings, drives.trips, std::vector<std::optional<double>>(fleet.cars), {});
}

/// First trip of the car that is in its last period.
double first_trip_of_last_period(const ChangingFleet& found, std::uint32_t car) {
    const double days =
        static_cast<double>(*found.cars[car].back().from_ms - begin_ms) / double(day_ms);
    return (days - 0.3 * car) / 3;
}

TEST(ChangingFleet, FindsTheCarThatReadsMoreAndTheOneThatScatters) {
    Fleet fleet;
    fleet.level = [](auto car, auto trip) { return car == 3 && trip >= 10 ? 1.1 : 1; };
    fleet.scatter = [](auto car, auto trip) { return car == 6 && trip >= 10 ? 3 : 1; };
    const auto found = calibrated(fleet, drives_of(fleet, 1));
    ASSERT_EQ(found.cars.size(), 8U);
    for (const std::uint32_t car : {0U, 1U, 2U, 4U, 5U, 7U}) {
        EXPECT_EQ(found.cars[car].size(), 1U) << car;
    }
    ASSERT_EQ(found.cars[3].size(), 2U);
    EXPECT_NEAR(first_trip_of_last_period(found, 3), 10, 2);
    const auto& change = *found.cars[3].back().change;
    EXPECT_NEAR(change.level, 0.1, 3 * change.level_sd);
    EXPECT_LT(change.level_sd, 0.02);
    EXPECT_EQ(change.scatter, 1);
    EXPECT_NEAR(found.cars[3][1].calibration->gain / found.cars[3][0].calibration->gain, 1.1, 0.04);

    ASSERT_EQ(found.cars[6].size(), 2U);
    EXPECT_NEAR(first_trip_of_last_period(found, 6), 10, 2);
    EXPECT_NEAR(found.cars[6].back().change->scatter, 3, 0.6); // the others scatter as well
    EXPECT_NEAR(found.cars[6].back().calibration->scatter, 3, 0.6);
    EXPECT_EQ(found.cars[6].front().calibration->scatter, 1);
}

TEST(ChangingFleet, FindsNoChangeWhereThereIsNoneAndCalibratesAsBefore) {
    unsigned with_change = 0;
    constexpr unsigned fleets = 60;
    for (unsigned seed = 1; seed <= fleets; ++seed) {
        const Fleet fleet{.places = 300, .places_of_trip = 100};
        const auto drives = drives_of(fleet, seed);
        const auto found = calibrated(fleet, drives);
        with_change +=
            std::ranges::any_of(found.cars, [](const auto& periods) { return periods.size() > 1; });
        if (seed == 1) {
            const auto expected = calibrate_fleet(
                drives.readings, std::vector<std::optional<double>>(fleet.cars), {});
            EXPECT_EQ(found.parts.cars, expected.cars);
        }
    }
    // At most 1 % of fleets, of which 60 have 2 or more with a probability of 12 %, 4 of 0.3 %.
    EXPECT_LT(with_change, 4U);
}

TEST(ChangingFleet, TellsTheCarThatChangedFromThoseThatAreComparedWithIt) {
    Fleet fleet{.cars = 3};
    fleet.level = [](auto car, auto trip) { return car == 1 && trip >= 12 ? 0.85 : 1; };
    const auto found = calibrated(fleet, drives_of(fleet, 4));
    EXPECT_EQ(found.cars[0].size(), 1U);
    ASSERT_EQ(found.cars[1].size(), 2U);
    EXPECT_EQ(found.cars[2].size(), 1U);
    EXPECT_NEAR(found.cars[1].back().change->level, -0.15, 0.06);
}

TEST(ChangingFleet, BlamesNeitherOfTwoCarsThatDisagree) {
    Fleet fleet{.cars = 2};
    fleet.level = [](auto car, auto trip) { return car == 1 && trip >= 10 ? 1.2 : 1; };
    const auto found = calibrated(fleet, drives_of(fleet, 5));
    EXPECT_EQ(found.cars[0].size(), 1U);
    EXPECT_EQ(found.cars[1].size(), 1U);
}

TEST(ChangingFleet, BlamesNoCarForRoadsThatChange) {
    Fleet fleet;
    fleet.road = [](auto place, double day) { return place < 200 && day > 30 ? 0.6 : 1; };
    const auto found = calibrated(fleet, drives_of(fleet, 6));
    ASSERT_EQ(found.cars.size(), fleet.cars);
    for (const auto& periods : found.cars) {
        EXPECT_EQ(periods.size(), 1U);
    }
}

TEST(ChangingFleet, FindsTwoChangesOfOneCar) {
    Fleet fleet{.trips_of_car = 30};
    fleet.level = [](auto car, auto trip) {
        return car == 2 && trip >= 10 && trip < 20 ? 1.15 : 1;
    };
    const auto found = calibrated(fleet, drives_of(fleet, 7));
    ASSERT_EQ(found.cars[2].size(), 3U);
    EXPECT_GT(found.cars[2][1].change->level, 0.1);
    EXPECT_LT(found.cars[2][2].change->level, -0.07);
}

TEST(ChangingFleet, StatesEachChangeOfAStaircaseRelativeToThePeriodBefore) {
    Fleet fleet{.trips_of_car = 60, .places = 300, .places_of_trip = 100};
    fleet.level = [](auto car, auto trip) {
        return car != 2 || trip < 20 ? 1 : trip < 40 ? 1.1 : 1.21;
    };
    const auto found = calibrated(fleet, drives_of(fleet, 10));
    ASSERT_EQ(found.cars[2].size(), 3U);
    for (const std::size_t period : {1U, 2U}) {
        const auto& change = *found.cars[2][period].change;
        // Twenty trips on either side that differ by 2 %: 0.6 %, and some more; three times as
        // much.
        EXPECT_NEAR(change.level, 0.1, 0.025) << period;
        EXPECT_GT(change.level_sd, 0.002) << period;
        EXPECT_LT(change.level_sd, 0.015) << period;
    }
}

TEST(ChangingFleet, WeighsACarThatChangedAsOneCar) {
    // Car 0 reads 20 % more than the others, and from its eleventh trip on 15 % more than before.
    // If its two periods counted as two cars, the mean of the fleet would move.
    Fleet fleet{.cars = 4};
    fleet.level = [](auto car, auto trip) { return car != 0 ? 1 : trip < 10 ? 1.2 : 1.2 * 1.15; };
    const auto drives = drives_of(fleet, 11);
    const auto found = calibrated(fleet, drives);
    ASSERT_EQ(found.cars[0].size(), 2U);
    const std::vector<double> stated_sd(fleet.cars, 0.05);
    const auto stated = calibrate_changing_fleet(drives.readings,
                                                 drives.trips,
                                                 std::vector<std::optional<double>>(fleet.cars),
                                                 {},
                                                 stated_sd);
    for (std::size_t car = 0; car < fleet.cars; ++car) {
        EXPECT_EQ(stated.cars[car], found.cars[car]) << car; // equal sds say as much as none
    }
}

TEST(ChangingFleet, LeavesUndatedTripsOfACarThatChangedInNoPeriod) {
    Fleet fleet;
    fleet.level = [](auto car, auto trip) { return car == 3 && trip >= 10 ? 1.2 : 1; };
    auto drives = drives_of(fleet, 8);
    drives.trips.utc_ms[3 * fleet.trips_of_car + 15].reset();
    const auto found = calibrated(fleet, drives);
    ASSERT_EQ(found.cars[3].size(), 2U);
    EXPECT_EQ(found.cars[3][0].shared + found.cars[3][1].shared, 19U * fleet.places_of_trip);
    EXPECT_EQ(period_at(found.cars[3], std::nullopt), 2U);
    EXPECT_EQ(period_at(found.cars[3], begin_ms), 0U);
    EXPECT_EQ(period_at(found.cars[3], found.cars[3][1].from_ms), 1U);
    EXPECT_EQ(period_at(found.cars[2], std::nullopt), 0U); // a car that did not change
}

TEST(CarDays, LeaveOutReadingsThatNoOtherCarMadeWithinTheYear) {
    Drives drives;
    for (std::uint32_t car = 0; car < 3; ++car) { // the third ten years after the others
        drives.trips.car.push_back(car);
        drives.trips.utc_ms.push_back(begin_ms + (car == 2 ? 3650 : car) * day_ms);
    }
    for (std::uint32_t place = 0; place < 30; ++place) {
        for (std::uint32_t car = 0; car < 3; ++car) {
            drives.readings.push_back({place, car, car, 2000.0 + place});
        }
    }
    FleetCalibration fleet{};
    fleet.cars.assign(3, CarCalibration{});
    fleet.is_known.assign(3, false);
    fleet.trip_sd = 0.02;
    fleet.rest_sd = 0.07;
    const auto days = car_days(drives.readings, drives.trips, fleet);
    ASSERT_EQ(days.size(), 3U);
    EXPECT_EQ(days[0].size(), 1U);
    EXPECT_EQ(days[1].size(), 1U);
    EXPECT_TRUE(days[2].empty());
}

TEST(ChangingFleet, CountsTripsOfOneDayOnce) {
    Fleet fleet;
    fleet.level = [](auto car, auto trip) { return car == 3 && trip >= 10 ? 1.2 : 1; };
    auto drives = drives_of(fleet, 9);
    for (std::size_t trip = 0; trip < drives.trips.car.size(); ++trip) {
        drives.trips.utc_ms[trip] = begin_ms + 60'000 * static_cast<std::int64_t>(trip);
    }
    const auto found = calibrated(fleet, drives);
    ASSERT_EQ(found.cars.size(), fleet.cars);
    for (const auto& periods : found.cars) {
        EXPECT_EQ(periods.size(), 1U); // 20 trips within two hours are one load, one weather
    }
}

} // namespace
} // namespace macadam
