#include "app/progress/remaining_time.hpp"

#include <gtest/gtest.h>

namespace macadam {
namespace {

using namespace std::chrono_literals;

const RemainingTime::Clock::time_point begin{};

TEST(RemainingTime, FollowsTheElapsedTimeAndTheShareThatIsDone) {
    RemainingTime time{begin};
    for (std::size_t s = 1; s <= 30; ++s) {
        time.add(begin + std::chrono::seconds{s}, s);
    }
    EXPECT_EQ(time.left(120), 90s);
}

TEST(RemainingTime, IsUnknownInTheFirstSeconds) {
    RemainingTime time{begin};
    time.add(begin + 4s, 50);
    EXPECT_EQ(time.left(100), std::nullopt);
    time.add(begin + 5s, 50);
    EXPECT_EQ(time.left(100), 5s);
}

TEST(RemainingTime, IsUnknownWithoutATotalOrWithoutProgress) {
    RemainingTime time{begin};
    time.add(begin + 60s, 0);
    EXPECT_EQ(time.left(100), std::nullopt);
    time.add(begin + 61s, 10);
    EXPECT_EQ(time.left(0), std::nullopt);
    for (int s = 62; s <= 200; ++s) { // nothing moves for more than two minutes
        time.add(begin + std::chrono::seconds{s}, 10);
    }
    EXPECT_EQ(time.left(100), std::nullopt);
}

TEST(RemainingTime, ForgetsHowFastTheFirstStepsWere) {
    RemainingTime time{begin};
    time.add(begin + 1s, 1000); // skipped trips
    for (std::size_t s = 2; s <= 300; ++s) {
        time.add(begin + std::chrono::seconds{s}, 1000 + s / 10);
    }
    const auto left = time.left(1040);
    ASSERT_TRUE(left.has_value());
    EXPECT_NEAR(static_cast<double>(left->count()), 100, 10);
}

} // namespace
} // namespace macadam
