// A car whose file is exact, on a measured road: tuning has nothing to find and must find nothing.

#include "driven_road.hpp"
#include "worlds.hpp"

#include "estimator/reference_data.hpp"
#include "estimator/smoother/smoothed_iri.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace macadam::testing {
namespace {

constexpr double length_m = 1600;

/// The laser profile of tests/data/sorel, forth and back again without end, so that its ends meet.
RoadUnderWheels measured_road() {
    const auto profile = sorel_even();
    const double step_m = profile.station_m[1] - profile.station_m[0];
    const auto count = static_cast<std::ptrdiff_t>(profile.elevation_m.size());
    RoadUnderWheels road;
    for (double s_m = 0; s_m < length_m; s_m += road.step_m) {
        const double at = s_m / step_m;
        const auto whole = static_cast<std::ptrdiff_t>(at);
        const auto elevation_m = [&](std::ptrdiff_t i) {
            const std::ptrdiff_t folded = i % (2 * (count - 1));
            return profile.elevation_m[static_cast<std::size_t>(
                folded < count ? folded : 2 * (count - 1) - folded)];
        };
        const double part = at - static_cast<double>(whole);
        road.left_m.push_back(
            static_cast<float>((1 - part) * elevation_m(whole) + part * elevation_m(whole + 1)));
    }
    road.right_m = road.left_m;
    return road;
}

/// Uncertain as vehicle files are, and right in every number.
Vehicle exact_car() {
    auto vehicle = two_axle_car({.wheelbase_m = 2.7, .cg_to_front_m = 1.3}, 0.1);
    vehicle.half_car.friction_n = 0;
    vehicle.uncertainty = {{"ms_kg", 0.08},
                           {"cs_ns_per_m", 0.10},
                           {"ks_n_per_m", 0.03},
                           {"kt_n_per_m", 0.03},
                           {"dynamic_index", unstated_dynamic_index_sd}};
    return vehicle;
}

Stretch drive_over(const RoadUnderWheels& road, const Vehicle& vehicle) {
    return with_sensors(stretch_over(road,
                                     {.road = {},
                                      .car = linear_car_of(vehicle),
                                      .length_m = length_m - 50,
                                      .speed_kmh = 72}),
                        {.vertical = true, .lateral = false, .roll = false, .pitch = true});
}

EstimatorConfig of_map() {
    EstimatorConfig config;
    config.method = Method::smoother;
    config.sensors = vertical_and_pitch;
    return config;
}

double mean_iri(const IriRun& run) {
    const auto& cells = run.centre_mm_per_m;
    return std::accumulate(cells.begin(), cells.end(), 0.0) / static_cast<double>(cells.size());
}

TEST(ExactCar, StaysWhatItsFileSaysOnAMeasuredRoad) {
    const auto vehicle = exact_car();
    const auto stretch = drive_over(measured_road(), vehicle);
    const auto tuned = car_in(stretch, {.vehicle = vehicle}, of_map()).vehicle;
    EXPECT_DOUBLE_EQ(tuned.half_car.ms_kg, vehicle.half_car.ms_kg);
    EXPECT_DOUBLE_EQ(tuned.half_car.cs_ns_per_m, vehicle.half_car.cs_ns_per_m);
    EXPECT_NEAR(tuned.half_car.ks_n_per_m / vehicle.half_car.ks_n_per_m, 1, 0.02);
    EXPECT_NEAR(tuned.half_car.kt_n_per_m / vehicle.half_car.kt_n_per_m, 1, 0.02);
    EXPECT_NEAR(tuned.axles->dynamic_index, 1, 0.02);
}

TEST(ExactCar, ReadsTheIriWithinAPercentOfWhatItReadsUntuned) {
    const auto vehicle = exact_car();
    auto certain = vehicle;
    certain.uncertainty.clear();
    const auto stretch = drive_over(measured_road(), vehicle);
    const auto iri_of = [&](const Vehicle& car) {
        return mean_iri(
            smoothed_iri(stretch, car_in(stretch, {.vehicle = car}, of_map()), of_map()));
    };
    EXPECT_NEAR(iri_of(vehicle) / iri_of(certain), 1, 0.01);
}

TEST(ExactCar, TellsADynamicIndexThatItsFileDoesNotState) {
    const auto stated = exact_car();
    for (const double truth : {0.92, 1.08}) {
        auto driven = stated;
        driven.axles->dynamic_index = truth;
        const auto stretch = drive_over(measured_road(), driven);
        const auto tuned = car_in(stretch, {.vehicle = stated}, of_map()).vehicle;
        EXPECT_NEAR(tuned.axles->dynamic_index, truth, 0.04);
    }
}

TEST(ExactCar, TellsASensorThatIsNotWhereItsFileSays) {
    const auto stated = exact_car();
    for (const double off_m : {-0.15, 0.15}) {
        auto driven = stated;
        driven.imu.x_m += off_m;
        const auto stretch = drive_over(measured_road(), driven);
        const auto tuned = car_in(stretch, {.vehicle = stated}, of_map()).vehicle;
        EXPECT_NEAR(tuned.imu.x_m, driven.imu.x_m, 0.08);
    }
}

} // namespace
} // namespace macadam::testing
