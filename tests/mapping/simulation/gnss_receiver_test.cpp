#include "mapping/simulation/gnss_receiver.hpp"

#include "mapping/simulation/smoothing.hpp"
#include "mapping/simulation/speed_profile.hpp"
#include "support/roads/road_art.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace macadam;
using namespace macadam::testing;

namespace {

struct Ride {
    DrivenPath path;
    Motion motion;
};

/// 2 km eastwards.
Ride ride() {
    const auto art = road_art("A----------B", 200, {"AB"});
    const std::vector route{edge_of(LinkId{0}, true)};
    DrivingRecipe driving;
    driving.wander_m = 0;
    const auto path = driven_path(art.roads, route, driving, 1);
    return {path, drive_along(path, art.roads, route, driving, 1)};
}

GnssRecipe faultless() {
    GnssRecipe gnss;
    gnss.sigma_m = gnss.white_m = gnss.speed_sd_mps = 0;
    gnss.outages_per_hour = 0;
    gnss.first_fix_s = {0, 0};
    return gnss;
}

double travel_at(const Motion& motion, double t_s) {
    return motion.travel_m[static_cast<std::size_t>(std::max(0.0, t_s) / motion.step_s)];
}

} // namespace

TEST(Receiver, SaysWhereTheCarWasALatencyAgo) {
    const auto [path, motion] = ride();
    const auto fixes = received_fixes(path, motion, faultless(), 1.0, 1);
    ASSERT_FALSE(fixes.empty());
    for (const auto& fix : fixes) {
        const auto was = path.plane.to_geo(place_at(path, travel_at(motion, fix.t_s - 1)).at);
        ASSERT_LT(distance_m(fix.at, was), 0.2); // one step of the motion: 0.1 m
    }
}

TEST(Receiver, WithoutFaultsGivesCourseAndSpeed) {
    const auto [path, motion] = ride();
    const auto fixes = received_fixes(path, motion, faultless(), 0, 1);
    const auto& fix = fixes[fixes.size() / 2];
    EXPECT_NEAR(fix.course_deg, 90, 0.1); // the middle of the plane is not under it
    EXPECT_NEAR(fix.speed_mps,
                motion.speed_mps[static_cast<std::size_t>(fix.t_s / motion.step_s)],
                0.02); // 1.4 m/s2 in one step
}

TEST(Receiver, PutsItsAntennaWhereItIsSaidToBe) {
    const auto [path, motion] = ride();
    auto gnss = faultless();
    const auto middle = received_fixes(path, motion, gnss, 0, 1);
    gnss.antenna_ahead_m = -1;
    gnss.antenna_left_m = 0.5;
    const auto behind = received_fixes(path, motion, gnss, 0, 1);
    const auto i = middle.size() / 2;
    EXPECT_LT(behind[i].at.lon_deg, middle[i].at.lon_deg);
    EXPECT_GT(behind[i].at.lat_deg, middle[i].at.lat_deg);
    EXPECT_NEAR(distance_m(behind[i].at, middle[i].at), std::hypot(1, 0.5), 1e-3);
}

TEST(Receiver, FallsSilentAsOftenAsStated) {
    const auto [path, motion] = ride();
    auto gnss = faultless();
    const auto whole = received_fixes(path, motion, gnss, 0, 1).size();
    gnss.first_fix_s = {20, 20};
    const auto late = received_fixes(path, motion, gnss, 0, 1);
    EXPECT_GE(late.front().t_s, 20);
    gnss.first_fix_s = {0, 0};
    gnss.outages_per_hour = 3600; // each second that has a fix
    gnss.outage_s = {9, 9};
    const auto rare = received_fixes(path, motion, gnss, 0, 1).size();
    EXPECT_LT(rare, whole / 4);
}

TEST(SlowNoise, HasItsDeviationAndForgets) {
    constexpr std::size_t count = 400'000;
    constexpr std::size_t steps = 50;
    const auto noise = slow_noise(count, 2, steps, 9);
    double squares = 0;
    double products = 0;
    for (std::size_t i = 0; i + steps < count; ++i) {
        squares += noise[i] * noise[i];
        products += noise[i] * noise[i + steps];
    }
    // 4000 independent ones: 1.1 % of the deviation; three of them.
    EXPECT_NEAR(std::sqrt(squares / static_cast<double>(count - steps)), 2, 0.07);
    const double expected = std::pow(50.0 / 51.0, 50); // nearly 1/e
    EXPECT_NEAR(products / squares, expected, 0.05);
}

TEST(WheelSpeed, IsTheTruthTimesItsScaleInWholeQuanta) {
    const auto motion = ride().motion;
    const OdometerRecipe odometer{
        .rate_hz = 50, .scale_sd = 0, .noise_mps = 0, .quantum_mps = 0.05};
    const auto speeds = wheel_speeds(motion, odometer, 1.02, 1);
    ASSERT_FALSE(speeds.t_s.empty());
    for (std::size_t i = 0; i < speeds.t_s.size(); ++i) {
        const auto at = static_cast<std::size_t>(speeds.t_s[i] / motion.step_s);
        ASSERT_NEAR(speeds.speed_mps[i], 1.02 * motion.speed_mps[at], 0.025 + 0.02);
        const double quanta = speeds.speed_mps[i] / 0.05;
        ASSERT_NEAR(quanta, std::round(quanta), 1e-4);
    }
}
