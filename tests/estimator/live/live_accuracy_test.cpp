// How much is lost by telling at once: live against offline, both against the true road.

#include "estimator/live/live_drive.hpp"
#include "estimator/smoother/worlds.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>

namespace macadam::testing {
namespace {

/// Errors of 20 m, relative to the mean truth of their drive.
struct Set {
    std::vector<Held> live, offline;
};

double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

Held held_of(const IriMean& mean, double truth) {
    return {mean.mri_mm_per_m.value_or(*mean.hri_mm_per_m), truth, mean.sd_mm_per_m};
}

/// Adds a drive. \returns seconds that were driven over seconds that telling them took.
double add_drive(const World& world, double speed_kmh, Method method, Set& set) {
    auto recipe = drive_in(world, speed_kmh);
    recipe.length_m = std::max(recipe.length_m, 3000.0);
    const auto drive = driven_road(recipe);
    const auto vehicle = two_axle_car(world.axles, world.imu_ahead_m);
    const auto trip = trip_of(drive.stretch);
    const auto config = live_config(method);

    const auto begin = std::chrono::steady_clock::now();
    const auto rows = told_live(trip, vehicle, config);
    const double quickness = trip.acc.t_s.back() / seconds_since(begin);

    const auto offline = offline_trace(trip, vehicle, config);
    const double off_m = drive.stretch.travel_m.front();
    std::vector<Held> live;
    std::vector<Held> later;
    for (const auto& row : rows) {
        const auto mean = mean_over(offline.trace, row.from_m, row.to_m, vehicle);
        if (row.mean.validity != validity::ok || mean.validity != validity::ok) {
            continue;
        }
        const auto index = mean.mri_mm_per_m ? Index::mri : Index::hri;
        const double truth = true_over(drive.truth, index, row.from_m + off_m, row.to_m + off_m);
        live.push_back(held_of(row.mean, truth));
        later.push_back(held_of(mean, truth));
    }
    append(set.live, live);
    append(set.offline, later);
    return quickness;
}

} // namespace

/// The number: within 10 % of the offline RMSE.
TEST(LiveTrace, IsAsNearToTheTruthAsTheWholeTrip) {
    Set set;
    for (const auto& world : worlds()) {
        for (const double speed_kmh : {30.0, 50.0, 80.0, 110.0}) {
            Set one;
            const double quickness = add_drive(world, speed_kmh, Method::smoother, one);
            std::printf("%-40s %3.0f km/h: RMSE %5.2f %% live, %5.2f %% offline; covered %3.0f and "
                        "%3.0f %%; %.0f times real time\n",
                        world.name,
                        speed_kmh,
                        100 * errors_of(one.live).rmse,
                        100 * errors_of(one.offline).rmse,
                        100 * errors_of(one.live).covered,
                        100 * errors_of(one.offline).covered,
                        quickness);
            set.live.insert(set.live.end(), one.live.begin(), one.live.end());
            set.offline.insert(set.offline.end(), one.offline.begin(), one.offline.end());
        }
    }
    const auto live = errors_of(set.live);
    const auto offline = errors_of(set.offline);
    std::printf(
        "all: RMSE %.2f %% live, %.2f %% offline; bias %+.2f and %+.2f %%; covered %.1f and "
        "%.1f %% of %zu\n",
        100 * live.rmse,
        100 * offline.rmse,
        100 * live.bias,
        100 * offline.bias,
        100 * live.covered,
        100 * offline.covered,
        set.live.size());
    EXPECT_LT(live.rmse, 1.1 * offline.rmse);
}

TEST(LiveTrace, OfThePublishedFilterIsAsNearToTheTruthAsTheWholeTrip) {
    Set set;
    for (const auto& world : worlds()) {
        add_drive(world, 80, Method::kf, set);
    }
    const double live = errors_of(set.live).rmse;
    const double offline = errors_of(set.offline).rmse;
    std::printf("kf: RMSE %.2f %% live, %.2f %% offline\n", 100 * live, 100 * offline);
    EXPECT_LT(live, 1.1 * offline);
}

} // namespace macadam::testing
