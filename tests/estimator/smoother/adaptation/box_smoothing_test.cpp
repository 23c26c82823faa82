#include "estimator/smoother/adaptation/box_smoothing.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace macadam::testing {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double rounding = 1e-12;

std::vector<double> impulse(std::size_t count, std::size_t at) {
    std::vector<double> values(count);
    values[at] = 1;
    return values;
}

/// What three boxes of 2 * reach + 1 values make of an impulse, by convolution as it is written.
std::vector<double> three_boxes(std::size_t reach) {
    const std::size_t width = 2 * reach + 1;
    std::vector<double> kernel{1};
    for (int pass = 0; pass < 3; ++pass) {
        std::vector<double> wider(kernel.size() + width - 1);
        for (std::size_t i = 0; i < kernel.size(); ++i) {
            for (std::size_t k = 0; k < width; ++k) {
                wider[i + k] += kernel[i] / static_cast<double>(width);
            }
        }
        kernel = std::move(wider);
    }
    return kernel;
}

} // namespace

TEST(Windowed, LeavesAConstantUpToItsEnds) {
    const auto values = windowed(std::vector<double>(50, 3.5), 12);
    EXPECT_THAT(values, Each(::testing::DoubleNear(3.5, rounding)));
}

TEST(Windowed, IsThreeBoxesAQuarterOfTheWindowToEitherSide) {
    const auto ours = windowed(impulse(101, 50), 20);
    const auto theirs = three_boxes(5);
    for (std::size_t i = 0; i < ours.size(); ++i) {
        const bool within = i >= 35 && i <= 65;
        EXPECT_NEAR(ours[i], within ? theirs[i - 35] : 0, rounding) << i;
    }
    EXPECT_NEAR(std::accumulate(ours.begin(), ours.end(), 0.0), 1, rounding);
}

TEST(Windowed, StaysBetweenTheLeastAndTheMostAtTheEnds) {
    const auto values = windowed(impulse(30, 0), 8);
    EXPECT_GE(*std::ranges::min_element(values), -rounding);
    EXPECT_LE(*std::ranges::max_element(values), 1);
    EXPECT_TRUE(std::ranges::is_sorted(values, std::ranges::greater{}));
}

TEST(Windowed, TakesOneNeighbourToEitherSideAtLeast) {
    const auto values = windowed(impulse(11, 5), 0);
    const auto theirs = three_boxes(1);
    ASSERT_FALSE(theirs.empty());
    ASSERT_EQ(values.size(), 11U);
    for (std::size_t i = 0; i < theirs.size(); ++i) {
        EXPECT_NEAR(values[i + 2], theirs[i], rounding);
    }
}

TEST(Windowed, OfNothingOrOneValueIsThat) {
    EXPECT_THAT(windowed({}, 10), IsEmpty());
    EXPECT_THAT(windowed({7}, 10), ElementsAre(7));
}

} // namespace macadam::testing
