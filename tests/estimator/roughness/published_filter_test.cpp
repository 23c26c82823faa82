// The published filter does what its paper says of it: on simulated drives of the car that it
// models, without noise and without its filters, nothing is lost but what the sampling loses. The
// roads are those of the simulation, the car is driven by Runge-Kutta over its forces; the truth is
// E1926 of the very same tracks.

#include "estimator/roughness/roughness_trace.hpp"
#include "estimator/simulated_car.hpp"
#include "estimator/simulation/road_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace macadam::testing {
namespace {

constexpr double length_m = 1500;
constexpr double from_m = 200; // the first 100 to 400 m after a start are the filter's own
constexpr double to_m = 1400;
constexpr double within = 0.005; // paper, section VI-B: "negligible errors"
constexpr double wavinesses[] = {1.5, 2, 2.5, 3};

const Vehicle& audi() {
    return *built_in_vehicle("audi-a6-etron");
}

struct Road {
    double waviness;
    WheelPaths paths;

    std::vector<double> combined(double left, double right) const {
        std::vector<double> sum_m(paths.left_m.size());
        for (std::size_t i = 0; i < sum_m.size(); ++i) {
            sum_m[i] = left * paths.left_m[i] + right * paths.right_m[i];
        }
        return sum_m;
    }
    double iri_of(double left, double right) const {
        return true_iri(combined(left, right), paths.step_m, from_m, to_m);
    }
};

Road road_of(double waviness) {
    return {waviness,
            wheel_paths(make_surface({.iri_mm_per_m = 3, .waviness = waviness}, length_m, 17))};
}

IriRun estimated(const Road& road, const Vehicle& car, Channels channels, double speed_mps) {
    const auto ride = drive(
        car,
        along(road.paths.left_m, road.paths.step_m),
        along(road.paths.right_m, road.paths.step_m),
        length_m - 10,
        [=](double) { return speed_mps; },
        1000,
        4);
    EstimatorConfig config;
    config.channels = channels;
    config.filters = false;
    config.lateral_regression = 1;
    return estimate_iri(stretch_of(ride, true, true), car, config);
}

/// Mean of one track's cells from from_m to to_m.
double mean_of(const IriRun& run, const std::vector<float>& cells) {
    const auto index = [&](double at_m) {
        return static_cast<std::size_t>((at_m - run.start_travel_m) / run.cell_m + 0.5);
    };
    double sum = 0;
    for (std::size_t i = index(from_m); i < index(to_m); ++i) {
        sum += static_cast<double>(cells[i]);
    }
    return sum / static_cast<double>(index(to_m) - index(from_m));
}

void expect_near(const char* what, double waviness, double found, double expected) {
    std::printf("%s, waviness %.1f: IRI %.3f, true %.3f mm/m (%+.2f %%)\n",
                what,
                waviness,
                found,
                expected,
                100 * (found / expected - 1));
    EXPECT_NEAR(found, expected, within * expected) << what << ", waviness " << waviness;
}

TEST(PublishedFilter, OfVerticalVibrationFindsTheIriOfTheMeanProfile) {
    for (const double waviness : wavinesses) {
        const auto road = road_of(waviness);
        for (const double speed_mps : {15.0, 29.0}) {
            const auto run = estimated(road, audi(), Channels::vertical, speed_mps);
            expect_near(
                "vertical", waviness, mean_of(run, run.centre_mm_per_m), road.iri_of(0.5, 0.5));
        }
    }
}

/// Whatever the tracks, what lateral vibration knows of them is half their difference.
TEST(PublishedFilter, OfLateralVibrationFindsTheIriOfHalfTheDifferenceOfTheTracks) {
    for (const double waviness : wavinesses) {
        const auto road = road_of(waviness);
        const auto run = estimated(road, audi(), Channels::lateral, 22);
        expect_near("lateral", waviness, mean_of(run, run.centre_mm_per_m), road.iri_of(0.5, -0.5));
    }
}

/// The paper's table III has the height folded into I_s; with the height apart it is the same.
TEST(PublishedFilter, OfBothFindsTheIriOfEachTrack) {
    Vehicle car = audi();
    car.imu.height_above_roll_axis_m = 0.4;
    for (const double waviness : wavinesses) {
        const auto road = road_of(waviness);
        const auto run = estimated(road, car, Channels::both, 22);
        expect_near("left of both", waviness, mean_of(run, run.left_mm_per_m), road.iri_of(1, 0));
        expect_near("right of both", waviness, mean_of(run, run.right_mm_per_m), road.iri_of(0, 1));
        expect_near(
            "mean of both", waviness, mean_of(run, run.centre_mm_per_m), road.iri_of(0.5, 0.5));
    }
}

} // namespace
} // namespace macadam::testing
