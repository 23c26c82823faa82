#include "mapping/fusion/fleet/fleet_calibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace macadam {
namespace {

struct Fleet {
    std::vector<double> gains;
    std::vector<double> offsets_um = std::vector<double>(gains.size(), 0.0);
    std::size_t trips_of_car = 10;
    std::size_t places = 400;
    double share = 0.3; ///< of the places that a trip passes
    double trip_sd = 0.02;
    double rest_sd = 0.06;
    std::vector<std::optional<double>> known =
        std::vector<std::optional<double>>(gains.size(), std::nullopt);
};

double level_um(std::size_t place) {
    return 1000 + 250 * static_cast<double>(place % 17);
}

std::vector<FleetReading> readings_of(const Fleet& fleet, unsigned seed) {
    std::mt19937 random{seed};
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    std::vector<double> of_trip(fleet.gains.size() * fleet.trips_of_car);
    for (auto& error : of_trip) {
        error = fleet.trip_sd * normal(random);
    }
    std::vector<FleetReading> readings;
    for (std::size_t place = 0; place < fleet.places; ++place) {
        for (std::size_t trip = 0; trip < of_trip.size(); ++trip) {
            const auto car = trip / fleet.trips_of_car;
            if (uniform(random) < fleet.share) {
                const double factor = fleet.known[car] ? 1
                                                       : fleet.gains[car] + of_trip[trip] +
                                                             fleet.rest_sd * normal(random);
                readings.push_back({static_cast<std::uint32_t>(place),
                                    static_cast<std::uint32_t>(car),
                                    static_cast<std::uint32_t>(trip),
                                    level_um(place) * factor + fleet.offsets_um[car]});
            }
        }
    }
    return readings;
}

/// Gains that differ by 6 %, the same each time.
std::vector<double> gains_of(std::size_t cars, unsigned seed) {
    std::mt19937 random{seed};
    std::normal_distribution<double> normal{1, 0.06};
    std::vector<double> gains;
    for (std::size_t i = 0; i < cars; ++i) {
        gains.push_back(normal(random));
    }
    return gains;
}

double mean_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) {
        sum += value;
    }
    return sum / static_cast<double>(values.size());
}

FleetPrior no_rest() {
    FleetPrior prior;
    prior.rest_sd_um = 0;
    return prior;
}

TEST(FleetCalibration, FindsHowMuchMoreOneCarReadsThanAnother) {
    const Fleet fleet{.gains = gains_of(20, 1)};
    const auto found = calibrate_fleet(readings_of(fleet, 2), fleet.known, no_rest());
    double square = 0;
    for (std::size_t car = 0; car < 20; ++car) {
        ASSERT_TRUE(found.cars[car]);
        const double at_2500 = found.cars[car]->gain + found.cars[car]->offset_um / 2500;
        square += std::pow(at_2500 - fleet.gains[car] / mean_of(fleet.gains), 2);
    }
    // Ten trips that differ by 2 % leave 0.63 %; the mean of the cars, which is robust, some more.
    EXPECT_LT(std::sqrt(square / 20), 0.011);
}

TEST(FleetCalibration, AnchorsTheFleetAtTheCarsThatStateTheLeastUncertainty) {
    // Two good cars that are right, and four taken for an average car, all of which read 12 % high.
    Fleet fleet{.gains = {1, 1, 1.12, 1.12, 1.12, 1.12}};
    const std::vector<double> stated_sd{0.05, 0.05, 0.25, 0.25, 0.25, 0.25};
    const auto readings = readings_of(fleet, 12);
    const auto alike = calibrate_fleet(readings, fleet.known, no_rest());
    const auto weighted = calibrate_fleet(readings, fleet.known, no_rest(), stated_sd);
    const auto at_2500 = [](const FleetCalibration& found, std::size_t car) {
        return found.cars[car]->gain + found.cars[car]->offset_um / 2500;
    };
    EXPECT_LT(at_2500(alike, 0), 0.95); // the mean of the cars is wrong by 8 %
    EXPECT_NEAR(at_2500(weighted, 0), 1, 0.02);
    EXPECT_NEAR(at_2500(weighted, 4), 1.12, 0.03);
    EXPECT_LT(weighted.anchor_sd, alike.anchor_sd);
}

TEST(FleetCalibration, TellsAnOffsetFromAGain) {
    Fleet fleet{.gains = std::vector<double>(12, 1.0), .share = 0.8};
    fleet.offsets_um[3] = 150;
    fleet.gains[7] = 1.1;
    const auto found = calibrate_fleet(readings_of(fleet, 3), fleet.known, no_rest());
    EXPECT_NEAR(found.cars[3]->offset_um, 150, 30);
    EXPECT_NEAR(found.cars[3]->gain, 1, 0.02);
    EXPECT_NEAR(found.cars[7]->offset_um, 0, 30);
    EXPECT_NEAR(found.cars[7]->gain, 1.1, 0.02);
}

TEST(FleetCalibration, FindsTheSpreadOfCarsTripsAndPasses) {
    const Fleet fleet{.gains = gains_of(40, 4)};
    const auto found = calibrate_fleet(readings_of(fleet, 5), fleet.known, no_rest());
    EXPECT_NEAR(found.rest_sd, 0.06, 0.003); // of 48,000 passes; t weights take a little of it
    EXPECT_NEAR(found.trip_sd, 0.02, 0.004);
    EXPECT_NEAR(found.car_sd, 0.06, 0.015); // the spread of 40 is known to 11 %, by medians 18 %
    EXPECT_NEAR(found.anchor_sd, found.car_sd / std::sqrt(40), 1e-12);
}

TEST(FleetCalibration, StatesWhatCarsAreStillOffBy) {
    double strange = 0;
    int cars = 0;
    for (unsigned seed = 1; seed <= 10; ++seed) {
        const Fleet fleet{.gains = gains_of(20, seed), .trips_of_car = 4};
        const auto found = calibrate_fleet(readings_of(fleet, seed + 100), fleet.known, no_rest());
        for (std::size_t car = 0; car < 20; ++car) {
            const auto& seen = found.cars[car].value();
            const double off =
                seen.gain + seen.offset_um / 2500 - fleet.gains[car] / mean_of(fleet.gains);
            strange += std::pow(off / seen.relative_sd, 2);
            ++cars;
        }
    }
    // 200 cars: the mean square is 1 within 0.1 where sds are right; they are a little on the safe
    // side, as nothing is claimed to be known better than to 1 %.
    EXPECT_GT(strange / cars, 0.4);
    EXPECT_LT(strange / cars, 1.3);
}

TEST(FleetCalibration, LetsABrokenCarMoveTheOthersLittle) {
    Fleet fleet{.gains = std::vector<double>(5, 1.0)};
    fleet.gains[2] = 1.5;
    const auto found = calibrate_fleet(readings_of(fleet, 6), fleet.known, no_rest());
    EXPECT_NEAR(found.cars[2]->gain / found.cars[0]->gain, 1.5, 0.05);
    for (const std::size_t good : {0U, 1U, 3U, 4U}) {
        EXPECT_NEAR(found.cars[good]->gain + found.cars[good]->offset_um / 2500, 1, 0.03);
    }
}

TEST(FleetCalibration, HoldsAllCarsAgainstASurvey) {
    Fleet fleet{.gains = std::vector<double>(9, 1.12)};
    fleet.known[0] = 0.02; // passed a third of the places
    const auto found = calibrate_fleet(readings_of(fleet, 7), fleet.known, no_rest());
    EXPECT_FALSE(found.cars[0]);
    for (std::size_t car = 1; car < 9; ++car) {
        EXPECT_NEAR(found.cars[car]->gain + found.cars[car]->offset_um / 2500, 1.12, 0.02);
    }
    EXPECT_NEAR(found.anchor_sd, 0.02, 0.005);
}

TEST(FleetCalibration, HoldsCarsThatNeverMetTheSurveyAgainstThoseThatDid) {
    // The survey passed every 25th place, as does the rest of the fleet by chance.
    Fleet fleet{.gains = std::vector<double>(6, 1.0), .share = 0.5};
    for (std::size_t car = 1; car < 6; ++car) {
        fleet.gains[car] = 0.9;
    }
    fleet.known[0] = 0.02;
    auto readings = readings_of(fleet, 8);
    std::erase_if(readings, [](const auto& r) { return r.car == 0 && r.place % 25 != 0; });
    const auto found = calibrate_fleet(readings, fleet.known, no_rest());
    for (std::size_t car = 1; car < 6; ++car) {
        EXPECT_NEAR(found.cars[car]->gain + found.cars[car]->offset_um / 2500, 0.9, 0.02);
    }
}

TEST(FleetCalibration, SaysNothingOfCarsThatShareTooLittle) {
    const Fleet fleet{.gains = std::vector<double>(3, 1.0), .places = 300};
    auto readings = readings_of(fleet, 9);
    std::erase_if(readings, [](const auto& r) { return r.car == 2 && r.place >= 30; });
    const auto found = calibrate_fleet(readings, fleet.known, no_rest());
    EXPECT_TRUE(found.cars[0]);
    EXPECT_FALSE(found.cars[2]);

    std::erase_if(readings, [](const auto& r) { return r.car != 0; });
    const auto alone = calibrate_fleet(readings, fleet.known, no_rest());
    EXPECT_FALSE(alone.cars[0]);
    EXPECT_EQ(alone.places, 0U);
}

TEST(FleetCalibration, LearnsNothingWhereOneCarPassedAlone) {
    const Fleet fleet{.gains = gains_of(4, 11), .share = 0.8};
    const auto readings = readings_of(fleet, 12);
    auto with_others = readings;
    for (auto& reading : with_others) {
        reading.place = 2 * reading.place + 1;
    }
    std::vector<FleetReading> alone;
    for (std::uint32_t place = 0; place < 400; ++place) {
        alone.push_back({2 * place, 3, 30 + place % 10, 700});
    }
    with_others.insert(with_others.end(), alone.begin(), alone.end());
    std::ranges::stable_sort(with_others, {}, &FleetReading::place);
    const auto expected = calibrate_fleet(readings, fleet.known, no_rest());
    const auto found = calibrate_fleet(with_others, fleet.known, no_rest());
    EXPECT_EQ(found.cars, expected.cars);
    EXPECT_EQ(found.shared, expected.shared);
}

TEST(FleetCalibration, JoinsTwoTownsByTheOneCarThatDroveInBoth) {
    Fleet fleet{.gains = {1.0, 1.0, 1.2, 1.2, 1.1}, .share = 0.6};
    auto readings = readings_of(fleet, 10);
    std::erase_if(readings, [](const auto& r) {
        const bool first_town = r.place < 200;
        return (r.car < 2 && !first_town) || ((r.car == 2 || r.car == 3) && first_town);
    });
    const auto found = calibrate_fleet(readings, fleet.known, no_rest());
    const auto at_2500 = [&](std::size_t car) {
        return found.cars[car]->gain + found.cars[car]->offset_um / 2500;
    };
    EXPECT_NEAR(at_2500(2) / at_2500(0), 1.2, 0.03);
    EXPECT_NEAR(at_2500(3) / at_2500(1), 1.2, 0.03);
}

} // namespace
} // namespace macadam
