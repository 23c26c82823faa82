#include "mapping/simulation/speed_profile.hpp"

#include "estimator/common/error.hpp"
#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace macadam;
using namespace macadam::testing;
using ::testing::Each;
using ::testing::Ge;
using ::testing::Le;

namespace {

struct Ride {
    DrivenPath path;
    Motion motion;
};

RoadArt town() {
    return road_art(R"(
        A----------B----------C
                   |
        D----------E----------F
    )",
                    100,
                    {"ABC", "DEF", "BE"});
}

/// Straight on, round two corners, and on.
Ride ride(const DrivingRecipe& driving, std::uint64_t seed = 5) {
    const auto art = town();
    const std::vector route{
        edge_between(art, 'A', 'B'), edge_between(art, 'B', 'E'), edge_between(art, 'E', 'F')};
    const auto path = driven_path(art.roads, route, driving, seed);
    return {path, drive_along(path, art.roads, route, driving, seed)};
}

DrivingRecipe without_stops() {
    DrivingRecipe driving;
    driving.stop_share = 0;
    return driving;
}

} // namespace

TEST(SpeedPlan, BeginsAndEndsAtRest) {
    const auto motion = ride({}).motion;
    const auto resting = static_cast<std::ptrdiff_t>(4 / motion.step_s);
    EXPECT_THAT((std::vector<double>{motion.speed_mps.begin(), motion.speed_mps.begin() + resting}),
                Each(Le(1e-9)));
    EXPECT_THAT((std::vector<double>{motion.speed_mps.end() - resting, motion.speed_mps.end()}),
                Each(Le(1e-9)));
}

TEST(SpeedPlan, DrivesThePathToItsEnd) {
    const auto [path, motion] = ride({});
    // 8 m of road lie before the car's first and after its last place.
    EXPECT_NEAR(motion.travel_m.back(), path.travel_m.back() - 8, 1.1); // whole points of the path
    EXPECT_TRUE(std::ranges::is_sorted(motion.travel_m));
}

TEST(SpeedPlan, SpeedIsTheRateOfTravelAndAccelerationThatOfSpeed) {
    const auto motion = ride({}).motion;
    ASSERT_GT(motion.travel_m.size(), 2U);
    for (std::size_t i = 1; i + 1 < motion.travel_m.size(); ++i) {
        const double v = (motion.travel_m[i + 1] - motion.travel_m[i - 1]) / (2 * motion.step_s);
        ASSERT_NEAR(v, motion.speed_mps[i], 1e-3);
    }
}

TEST(SpeedPlan, KeepsWithinPedalsAndBrakes) {
    const auto driving = without_stops();
    const auto motion = ride(driving).motion;
    EXPECT_THAT(motion.acc_mps2, Each(Le(driving.acceleration_mps2 + 1e-6)));
    EXPECT_THAT(motion.acc_mps2, Each(Ge(-driving.braking_mps2 - 1e-6)));
}

TEST(SpeedPlan, GoesRoundCornersAsFastAsItMay) {
    const auto driving = without_stops();
    const auto motion = ride(driving).motion;
    double hardest = 0;
    for (std::size_t i = 0; i < motion.speed_mps.size(); ++i) {
        hardest = std::max(hardest, std::abs(motion.speed_mps[i] * motion.yaw_rate_radps[i]));
    }
    // The foot is smoothed over a second, in which the corner changes.
    EXPECT_LT(hardest, 1.3 * driving.lateral_mps2);
    EXPECT_GT(hardest, 0.7 * driving.lateral_mps2);
}

TEST(SpeedPlan, StopsAtEveryJunctionIfItMust) {
    DrivingRecipe driving;
    driving.stop_share = 1;
    driving.stop_s = {10, 10};
    const auto stopping = ride(driving).motion;
    double standing_s = 0;
    for (const double v : stopping.speed_mps) {
        standing_s += v < 1e-9 ? stopping.step_s : 0;
    }
    // Twice 10 s at junctions and 6 s at both ends, less 0.7 s of foot at each side of a stop.
    EXPECT_NEAR(standing_s, 2 * (10 - 1.4) + 2 * (6 - 0.7), 0.5);
}

TEST(SpeedPlan, RefusesATripThatIsTooShortToDrive) {
    const auto art = road_art("A--B", 10, {"AB"});
    const std::vector route{edge_of(LinkId{0}, true)};
    const auto path = driven_path(art.roads, route, {}, 1);
    try {
        drive_along(path, art.roads, route, {}, 1);
        FAIL() << "30 m were driven";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), ::testing::StartsWith("a trip of 30 m was drawn, expected"));
    }
}
