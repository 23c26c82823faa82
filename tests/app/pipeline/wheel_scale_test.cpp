// The wheels of a recorded drive against its receiver: a scale fitted on the first half holds on
// the second.

#include "estimator/motion/make_odometer.hpp"
#include "estimator/motion/odometer.hpp"
#include "storage/trips/trip_reader.hpp"
#include "support/program/places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <vector>

namespace macadam::testing {
namespace {

constexpr double middle_s = 30; // of 60 s
constexpr double end_s = 59;

TripLog recorded_drive() {
    const auto source =
        std::filesystem::path{source_folder()} / "sample_data/comma2k19/comma2k19_rav4.trip.csv";
    return read_trip(TripSource{source, {}}, needs_of_trace(), {});
}

/// What was recorded from one time to another. Fixes count by when they were true.
TripLog part_of(const TripLog& trip, double from_s, double to_s) {
    TripLog part;
    part.meta = trip.meta;
    for (std::size_t i = 0; i < trip.speed.t_s.size(); ++i) {
        if (trip.speed.t_s[i] >= from_s && trip.speed.t_s[i] <= to_s) {
            part.speed.t_s.push_back(trip.speed.t_s[i]);
            part.speed.speed_mps.push_back(trip.speed.speed_mps[i]);
        }
    }
    for (const auto& fix : trip.fixes) {
        const double true_s = fix.t_s - trip.meta.gnss_latency_s;
        if (true_s >= from_s && true_s <= to_s) {
            part.fixes.push_back(fix);
        }
    }
    return part;
}

/// Trapezes under the receiver's own speed, from the first fix to the last.
double receivers_m(const TripLog& trip) {
    double sum_m = 0;
    for (std::size_t i = 1; i < trip.fixes.size(); ++i) {
        const auto& [before, now] = std::pair{trip.fixes[i - 1], trip.fixes[i]};
        sum_m += (now.t_s - before.t_s) * static_cast<double>(before.speed_mps + now.speed_mps) / 2;
    }
    return sum_m;
}

double wheels_m(const TripLog& trip, double scale, double from_s, double to_s) {
    auto scaled = trip;
    scaled.meta.speed_scale = scale;
    const auto odometer = make_odometer(scaled, OdometerConfig{}).odometer;
    return odometer.travel_m(to_s) - odometer.travel_m(from_s);
}

TEST(WheelScale, OfTheFirstHalfOfARecordedDriveHoldsOnTheSecond) {
    const auto trip = recorded_drive();
    const auto first = part_of(trip, 0, middle_s);
    const double scale = make_odometer(first, OdometerConfig{}).odometer.scale();

    const auto second = part_of(trip, middle_s, end_s);
    const double latency_s = trip.meta.gnss_latency_s;
    const double by_wheels_m = wheels_m(
        trip, scale, second.fixes.front().t_s - latency_s, second.fixes.back().t_s - latency_s);
    const double by_receiver_m = receivers_m(second);
    std::printf("scale %.4f; second half: wheels %.2f m, receiver %.2f m (%+.2f %%)\n",
                scale,
                by_wheels_m,
                by_receiver_m,
                100 * (by_wheels_m / by_receiver_m - 1));
    EXPECT_GT(by_receiver_m, 400);
    EXPECT_NEAR(by_wheels_m, by_receiver_m, 0.003 * by_receiver_m);
}

/// What the wheels themselves say is off by more: the scale does something.
TEST(WheelScale, OfOneMissesTheReceiverOnThisDrive) {
    const auto trip = recorded_drive();
    const auto second = part_of(trip, middle_s, end_s);
    const double latency_s = trip.meta.gnss_latency_s;
    const double by_wheels_m = wheels_m(
        trip, 1, second.fixes.front().t_s - latency_s, second.fixes.back().t_s - latency_s);
    EXPECT_GT(std::abs(by_wheels_m / receivers_m(second) - 1), 0.005);
}

} // namespace
} // namespace macadam::testing
