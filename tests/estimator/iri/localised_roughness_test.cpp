#include "estimator/iri/localised_roughness.hpp"

#include <gmock/gmock.h>

#include <random>
#include <vector>

namespace macadam::testing {
namespace {

std::vector<double> rough_values(std::size_t count) {
    std::mt19937 random{11};
    std::exponential_distribution<double> value{0.5};
    std::vector<double> values(count);
    for (double& one : values) {
        one = value(random);
    }
    return values;
}

std::vector<RoughInterval> places_above(double threshold, const std::vector<double>& values) {
    RoughIntervalFinder seeker{threshold};
    std::vector<RoughInterval> places;
    const auto add = [&](const std::optional<RoughInterval>& place) {
        if (place) {
            places.push_back(*place);
        }
    };
    for (std::size_t i = 0; i < values.size(); ++i) {
        add(seeker.push(10 * static_cast<double>(i), values[i]));
    }
    add(seeker.finish());
    return places;
}

TEST(MovingMean, IsTheMeanOfTheLastValues) {
    const auto values = rough_values(1000);
    ASSERT_EQ(values.size(), 1000U);
    for (const std::size_t count : {1U, 2U, 30U, 152U}) {
        MovingMean mean{static_cast<double>(count)};
        for (std::size_t i = 0; i < values.size(); ++i) {
            const auto moved = mean.push(values[i]);
            ASSERT_EQ(moved.has_value(), i + 1 >= count);
            if (!moved) {
                continue;
            }
            double sum = 0;
            for (std::size_t j = i + 1 - count; j <= i; ++j) {
                sum += values[j];
            }
            ASSERT_NEAR(*moved, sum / static_cast<double>(count), 1e-12);
        }
    }
}

TEST(MovingMean, TakesAPartOfTheOldestWhereTheBaseEndsWithinIt) {
    MovingMean mean{2.5};
    EXPECT_FALSE(mean.push(8));
    EXPECT_FALSE(mean.push(1));
    EXPECT_DOUBLE_EQ(mean.push(2).value(), (0.5 * 8 + 1 + 2) / 2.5);
    EXPECT_DOUBLE_EQ(mean.push(4).value(), (0.5 * 1 + 2 + 4) / 2.5);
}

/// 20 million values are 1,000 km of 50 mm. A sum of them all loses 1e-9 of them.
TEST(MovingMean, DoesNotDriftOverMillionsOfValues) {
    MovingMean mean{152};
    double last = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        last = mean.push(i < 999'000 ? 1e6 + i : 0.1).value_or(0);
    }
    EXPECT_NEAR(last, 0.1, 1e-15);
}

TEST(RoughIntervalFinder, AreWhereTheValuesStayAboveTheThreshold) {
    const auto places = places_above(2, {3, 1, 2, 2.5, 4, 2.1, 2, 5});
    ASSERT_EQ(places.size(), 3U);
    EXPECT_EQ(places[0].from_m, 0);
    EXPECT_EQ(places[0].to_m, 0);
    EXPECT_EQ(places[1].from_m, 30);
    EXPECT_EQ(places[1].to_m, 50);
    EXPECT_EQ(places[1].peak, 4);
    EXPECT_EQ(places[1].peak_at_m, 40);
    EXPECT_EQ(places[2].from_m, 70); // lasts until the end
}

TEST(RoughIntervalFinder, AreNoneOnASmoothRoad) {
    EXPECT_TRUE(places_above(2, {0, 1, 2}).empty());
    EXPECT_TRUE(places_above(2, {}).empty());
}

} // namespace
} // namespace macadam::testing
