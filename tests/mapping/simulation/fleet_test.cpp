#include "mapping/simulation/fleet.hpp"

#include "estimator/common/error.hpp"
#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

using namespace macadam;
using namespace macadam::testing;

namespace {

RoadArt town() {
    return road_art(R"(
        A---B---C
        |   |   |
        D---E---F
    )",
                    100,
                    {"ABC", "DEF", "AD", "BE", "CF"});
}

FleetScenario recipe_of(std::size_t cars) {
    FleetScenario recipe;
    for (std::size_t i = 0; i < cars; ++i) {
        FleetCarRecipe car;
        car.car.vehicle = *built_in_vehicle("generic");
        car.car.vehicle.axles = Axles{.wheelbase_m = 2.7, .cg_to_front_m = 1.2};
        car.car.vehicle.name = "car-" + std::to_string(i);
        recipe.cars.push_back(car);
    }
    recipe.driving.length_km = {0.5, 0.8};
    recipe.driving.trips = 2 * cars;
    return recipe;
}

/// Lanes made anew each time.
LaneSource lanes_of(const Fleet& fleet, const RoadNetwork& roads) {
    return [&](const Lane& lane) {
        return std::make_shared<const RoadSurface>(
            lane_surface(fleet.recipe, roads, lane, fleet.seed));
    };
}

} // namespace

TEST(Fleet, WritesTheTruthOfItsCarsIfItKnowsIt) {
    auto recipe = recipe_of(1);
    recipe.knowledge_sd = 0;
    const auto art = town();
    const auto car = make_fleet(recipe, art.roads, 1).cars.front();
    EXPECT_EQ(car.written.half_car.ks_n_per_m, car.car.vehicle.half_car.ks_n_per_m);
    EXPECT_EQ(car.written.half_car.is_kgm2, car.car.vehicle.half_car.is_kgm2);
    EXPECT_EQ(car.written.half_car.antiroll_n_per_m, car.car.antiroll_n_per_m);
    EXPECT_EQ(car.written.gain, 1);
    EXPECT_EQ(car.written.one_axle_gain, 0.72);
}

TEST(Fleet, WritesItsCarsAsWrongAsStated) {
    auto recipe = recipe_of(400);
    recipe.knowledge_sd = 0.05;
    const auto art = town();
    double squares = 0;
    for (const auto& car : make_fleet(recipe, art.roads, 1).cars) {
        const double off = car.written.half_car.cs_ns_per_m / car.car.vehicle.half_car.cs_ns_per_m;
        squares += (off - 1) * (off - 1);
        EXPECT_EQ(car.written.uncertainty.at("cs_ns_per_m"), 0.05);
        EXPECT_EQ(car.written.axles->wheelbase_m, 2.7);
    }
    // Cut at 2.5 sd it keeps 97 %; 400 draws know it to 3.5 %, three times that.
    EXPECT_NEAR(std::sqrt(squares / 400), 0.0485, 0.005);
}

TEST(Fleet, GivesEveryCarItsTurnAndTheWayBackToTheSame) {
    auto recipe = recipe_of(3);
    recipe.driving.return_share = 0.5;
    const auto art = town();
    const auto fleet = make_fleet(recipe, art.roads, 1);
    const auto lanes = lanes_of(fleet, art.roads);
    std::set<std::string> cars;
    std::string last;
    for (std::size_t trip = 0; trip < 6; ++trip) {
        const auto id = simulate_trip(fleet, art.roads, lanes, trip).meta.vehicle_id;
        EXPECT_TRUE(trip % 2 == 0 || id == last);
        cars.insert(id);
        last = id;
    }
    EXPECT_EQ(cars.size(), 3U);
}

TEST(Fleet, LogsOnlyTheSensorsOfACar) {
    auto recipe = recipe_of(1);
    recipe.cars[0].gyro = false;
    recipe.cars[0].wheel_speed = false;
    const auto art = town();
    const auto fleet = make_fleet(recipe, art.roads, 1);
    const auto trip = simulate_trip(fleet, art.roads, lanes_of(fleet, art.roads), 0);
    EXPECT_FALSE(trip.acc.t_s.empty());
    EXPECT_TRUE(trip.gyro.t_s.empty());
    EXPECT_TRUE(trip.speed.t_s.empty());
    EXPECT_FALSE(trip.fixes.empty());
}

TEST(Fleet, StatesALatencyOnlyIfToldTo) {
    auto recipe = recipe_of(1);
    recipe.gnss.latency_s = {0.3, 0.3};
    const auto art = town();
    for (const bool stated : {false, true}) {
        recipe.gnss.latency_stated = stated;
        const auto fleet = make_fleet(recipe, art.roads, 1);
        const auto meta = simulate_trip(fleet, art.roads, lanes_of(fleet, art.roads), 0).meta;
        EXPECT_EQ(meta.gnss_latency_stated, stated);
        EXPECT_EQ(meta.gnss_latency_s, stated ? 0.3 : 0);
    }
}

TEST(Fleet, DrivesWithinItsDaysInTheOrderOfItsTrips) {
    auto recipe = recipe_of(2);
    recipe.driving.from_utc_s = 1735689600; // 2025-01-01
    recipe.driving.to_utc_s = 1735689600 + 9 * 86400;
    const auto art = town();
    const auto fleet = make_fleet(recipe, art.roads, 1);
    double last_s = 0;
    for (std::size_t trip = 0; trip < recipe.driving.trips; trip += 2) {
        const double out_s =
            *simulate_trip(fleet, art.roads, lanes_of(fleet, art.roads), trip).meta.t0_utc_s;
        const double back_s =
            *simulate_trip(fleet, art.roads, lanes_of(fleet, art.roads), trip + 1).meta.t0_utc_s;
        EXPECT_GT(out_s, last_s);
        EXPECT_GT(back_s, out_s);
        last_s = back_s;
    }
    EXPECT_LT(last_s, 1735689600 + 10 * 86400);
}

TEST(Fleet, NeedsACar) {
    const auto art = town();
    EXPECT_THROW(make_fleet({}, art.roads, 1), InputError);
}
