#include "estimator/smoother/adaptation/road_prior_scale.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace macadam::testing {
namespace {

constexpr double cell_m = 0.25;
constexpr ObservedModes both{true, true};

RoadGrid grid_of(double length_m) {
    return {cell_m, 0, static_cast<std::size_t>(length_m / cell_m)};
}

/// A road of which every increment is known.
SmoothedRoad seen_road(std::size_t cells) {
    SmoothedRoad road;
    road.increment_m.resize(cells);
    road.perturbed_m.resize(cells);
    return road;
}

double normal(std::mt19937& random) {
    return std::normal_distribution<double>{}(random);
}

/// Mean and half difference are independent, of the variances that `of` gives at each place.
SmoothedRoad drawn_road(const RoadGrid& grid, auto of) {
    std::mt19937 random{4};
    auto road = seen_road(grid.cells);
    for (std::size_t i = 0; i < grid.cells; ++i) {
        const Pair variance = of(static_cast<double>(i) * cell_m);
        road.increment_m[i] = {std::sqrt(variance.mean) * normal(random),
                               std::sqrt(variance.half) * normal(random)};
    }
    return road;
}

RoadLevel
settled(const RoadGrid& grid, ObservedModes felt, const SmoothedRoad& road, int rounds = 15) {
    auto level = even_level(grid, felt, 2e-6);
    for (int round = 0; round < rounds; ++round) {
        level = adapted(std::move(level), road, grid);
    }
    return level;
}

/// Mean over a part of the road of one side of what the filter is given.
double prior_over(const RoadLevel& level, double from_m, double to_m, double Increment::*side) {
    const auto from = static_cast<std::size_t>(from_m / cell_m);
    const auto to = static_cast<std::size_t>(to_m / cell_m);
    double sum = 0;
    for (std::size_t i = from; i < to; ++i) {
        sum += level.prior.increments[i].*side;
    }
    return sum / static_cast<double>(to - from);
}

/// Mean square of the increments over their own variances.
double seen_over_expected(const RoadLevel& level,
                          const SmoothedRoad& road,
                          double from_m,
                          double to_m,
                          double Increment::*variance,
                          double Pair::*side) {
    const auto from = static_cast<std::size_t>(from_m / cell_m);
    const auto to = static_cast<std::size_t>(to_m / cell_m);
    double sum = 0;
    for (std::size_t i = from; i < to; ++i) {
        sum += std::pow(road.increment_m[i].*side, 2) / (level.prior.increments[i].*variance);
    }
    return sum / static_cast<double>(to - from);
}

double level_at(const RoadLevel& level, double at_m) {
    return level.level[static_cast<std::size_t>(at_m / cell_m)].mean;
}

} // namespace

/// 2,400 increments tell a variance to 3 %; three of that.
TEST(RoadLevel, SettlesWhereWhatIsSeenIsAsLargeAsItSays) {
    const auto grid = grid_of(1000);
    const auto road = drawn_road(grid, [](double) { return Pair{4e-6, 1e-6}; });
    const auto level = settled(grid, both, road);
    EXPECT_NEAR(seen_over_expected(level, road, 200, 800, &Increment::mean, &Pair::mean), 1, 0.09);
    EXPECT_NEAR(seen_over_expected(level, road, 200, 800, &Increment::half, &Pair::half), 1, 0.09);
}

/// A factor that follows each increment takes some of it out of the mean; a fifth at most.
TEST(RoadLevel, IsNearTheVarianceOfAnEvenRoad) {
    const auto grid = grid_of(1000);
    const auto road = drawn_road(grid, [](double) { return Pair{4e-6, 1e-6}; });
    const auto level = settled(grid, both, road);
    EXPECT_NEAR(prior_over(level, 200, 800, &Increment::mean) / 4e-6, 0.85, 0.1);
    EXPECT_NEAR(prior_over(level, 200, 800, &Increment::half) / 1e-6, 0.85, 0.1);
}

TEST(RoadLevel, ForgetsWhereItBegan) {
    const auto grid = grid_of(600);
    const auto road = drawn_road(grid, [](double) { return Pair{4e-6, 1e-6}; });
    auto high = even_level(grid, both, 2e-4); // an IRI ten times that of the other
    for (int round = 0; round < 12; ++round) {
        high = adapted(std::move(high), road, grid);
    }
    const auto low = settled(grid, both, road, 12);
    EXPECT_NEAR(prior_over(high, 200, 400, &Increment::mean) /
                    prior_over(low, 200, 400, &Increment::mean),
                1,
                0.05);
}

TEST(RoadLevel, FollowsAStepWithinItsWindow) {
    const auto grid = grid_of(1600);
    const auto road = drawn_road(grid, [](double at_m) {
        return at_m < 800 ? Pair{1e-6, 3e-7} : Pair{16e-6, 48e-7};
    });
    const auto level = settled(grid, both, road);
    EXPECT_NEAR(prior_over(level, 1000, 1500, &Increment::mean) /
                    prior_over(level, 100, 600, &Increment::mean),
                16,
                3);
    EXPECT_NEAR(level_at(level, 650) / level_at(level, 350), 1, 0.3);
    EXPECT_NEAR(level_at(level, 950) / level_at(level, 1250), 1, 0.3);
}

TEST(RoadLevel, RaisesAFactorAtAJointAndNotTheLevelAroundIt) {
    const auto grid = grid_of(1000);
    auto road = drawn_road(grid, [](double) { return Pair{1e-6, 3e-7}; });
    const auto without = settled(grid, both, road);
    road.increment_m[2000] = {0.01, 0}; // 10 mm, ten standard deviations
    const auto with = settled(grid, both, road);
    EXPECT_GT(with.tail[2000].mean, 10 * without.tail[2000].mean);
    EXPECT_GT(with.tail[2000].mean, 15);
    EXPECT_NEAR(with.tail[2010].mean / without.tail[2010].mean, 1, 0.1);
    EXPECT_NEAR(level_at(with, 500) / level_at(without, 500), 1, 0.1);
}

/// Student's t with 3 degrees of freedom: the filter is given large variances where large
/// increments are. What is left of each over its own variance has lost the tail: its kurtosis
/// (infinite of the increments) falls to less than a normal number's 3.
TEST(RoadLevel, OnHeavyTailsLeavesNothingThatStandsOut) {
    const auto grid = grid_of(2000);
    std::mt19937 random{9};
    std::student_t_distribution<double> student{3};
    auto road = seen_road(grid.cells);
    for (auto& increment : road.increment_m) {
        increment = {0.001 * student(random), 0.0005 * student(random)};
    }
    const auto level = settled(grid, both, road);
    double square = 0;
    double fourth = 0;
    double raw_square = 0;
    double raw_fourth = 0;
    for (std::size_t i = 0; i < grid.cells; ++i) {
        const double x = road.increment_m[i].mean;
        const double z = x * x / level.prior.increments[i].mean;
        square += z;
        fourth += z * z;
        raw_square += x * x;
        raw_fourth += x * x * x * x;
    }
    const auto n = static_cast<double>(grid.cells);
    EXPECT_GT(n * raw_fourth / (raw_square * raw_square), 10);
    EXPECT_LT(n * fourth / (square * square), 3);
}

TEST(RoadLevel, TakesTheHalfDifferenceFromTheMeanWhereThatAloneIsFelt) {
    const auto grid = grid_of(1000);
    const auto road = drawn_road(grid, [](double) { return Pair{4e-6, 0}; });
    const auto level = settled(grid, {true, false}, road);
    for (const std::size_t i : {500U, 2000U, 3500U}) {
        EXPECT_NEAR(level.level[i].half / level.level[i].mean, 0.3, 1e-9);
        EXPECT_EQ(level.tail[i].half, level.tail[i].mean);
        EXPECT_EQ(level.level[i].cross, 0);
    }
}

TEST(RoadLevel, TakesTheMeanFromTheHalfDifferenceWhereThatAloneIsFelt) {
    const auto grid = grid_of(1000);
    const auto road = drawn_road(grid, [](double) { return Pair{0, 1e-6}; });
    const auto level = settled(grid, {false, true}, road);
    for (const std::size_t i : {500U, 2000U, 3500U}) {
        EXPECT_NEAR(level.level[i].half / level.level[i].mean, 0.3, 1e-9);
        EXPECT_EQ(level.tail[i].half, level.tail[i].mean);
    }
    EXPECT_NEAR(prior_over(level, 200, 800, &Increment::half) / 1e-6, 1, 0.09);
}

/// Only the left track is rough: mean and half difference are one and the same.
TEST(RoadLevel, FindsThatOneTrackIsTheRougher) {
    const auto grid = grid_of(1000);
    const auto correlation = [&](double left_sd_m, double right_sd_m) {
        std::mt19937 random{5};
        auto road = seen_road(grid.cells);
        for (auto& increment : road.increment_m) {
            const double left = left_sd_m * normal(random);
            const double right = right_sd_m * normal(random);
            increment = {(left + right) / 2, (left - right) / 2};
        }
        const auto level = settled(grid, both, road);
        const auto& q = level.level[2000];
        return q.cross / std::sqrt(q.mean * q.half);
    };
    // (4 - 1) / (4 + 1); 400 increments tell it to 0.05.
    EXPECT_NEAR(correlation(0.002, 0.001), 0.6, 0.15);
    EXPECT_NEAR(correlation(0.001, 0.002), -0.6, 0.15);
    EXPECT_NEAR(correlation(0.001, 0.001), 0, 0.15);
}

/// A posterior that knows nothing gives the prior back in its draw and no increments: the level
/// falls only by what the least share that is counted allows, and stays a number.
TEST(RoadLevel, StaysANumberWhereNothingIsFelt) {
    const auto grid = grid_of(500);
    auto level = even_level(grid, both, 2e-6);
    for (int round = 0; round < 12; ++round) {
        auto road = seen_road(grid.cells);
        std::mt19937 random{static_cast<unsigned>(round)};
        for (std::size_t i = 0; i < grid.cells; ++i) {
            const auto& q = level.prior.increments[i];
            road.perturbed_m[i] = {std::sqrt(q.mean) * normal(random),
                                   std::sqrt(q.half) * normal(random)};
        }
        level = adapted(std::move(level), road, grid);
    }
    ASSERT_GE(level.prior.increments.size(), grid.cells);
    for (const auto& q : level.prior.increments) {
        ASSERT_TRUE(std::isfinite(q.mean) && q.mean > 0);
        ASSERT_LT(q.cross * q.cross, q.mean * q.half);
    }
}

TEST(FeltBy, TellsWhichSidesTheChannelsFeel) {
    DriveRecord drive;
    const auto felt = [&](Channel channel) {
        DriveRecord one;
        one.felt[static_cast<std::size_t>(channel)] = {1, 2};
        return felt_by({&one, 1});
    };
    EXPECT_FALSE(felt_by({&drive, 1}).mean || felt_by({&drive, 1}).half);
    EXPECT_TRUE(felt(Channel::vertical).mean && !felt(Channel::vertical).half);
    EXPECT_TRUE(felt(Channel::pitch_rate).mean && !felt(Channel::pitch_rate).half);
    EXPECT_TRUE(felt(Channel::lateral).half && !felt(Channel::lateral).mean);
    EXPECT_TRUE(felt(Channel::roll_rate).half && !felt(Channel::roll_rate).mean);
}

} // namespace macadam::testing
