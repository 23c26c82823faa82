#include "estimator/simulation/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <vector>

namespace macadam::testing {
namespace {

constexpr int draws = 100'000;

/// The generator's published definition, run in another language.
TEST(Random, MeetsTheGeneratorsPublishedDefinition) {
    Random random{1234567};
    EXPECT_EQ(random.bits(), 0x0610e053dd55ab68U);
    EXPECT_EQ(random.bits(), 0x70c979e26e27fbacU);
    EXPECT_EQ(random.bits(), 0xfb95f99f9f6bb2deU);
    EXPECT_EQ(random.bits(), 0x03890aaecd9fa80aU);
}

TEST(Random, NormalNumbersAreTheSameBitsOnEveryMachine) {
    Random random{1};
    std::uint64_t sum = 0;
    for (int i = 0; i < 1000; ++i) {
        sum = sum * 31 + std::bit_cast<std::uint64_t>(random.normal());
    }
    EXPECT_EQ(sum, 6432862061858140104U);
}

TEST(Random, NormalNumbersHaveTheMomentsOfTheirDistribution) {
    Random random{7};
    std::array<double, 5> moment{};
    for (int i = 0; i < draws; ++i) {
        const double x = random.normal();
        for (std::size_t k = 1; k < moment.size(); ++k) {
            moment[k] += std::pow(x, static_cast<double>(k)) / draws;
        }
    }
    // Four standard errors of each.
    EXPECT_NEAR(moment[1], 0, 4 / std::sqrt(draws));
    EXPECT_NEAR(moment[2], 1, 4 * std::sqrt(2.0 / draws));
    EXPECT_NEAR(moment[3], 0, 4 * std::sqrt(15.0 / draws));
    EXPECT_NEAR(moment[4], 3, 4 * std::sqrt(96.0 / draws));
}

TEST(Random, NormalNumbersHaveTheTailsOfTheirDistribution) {
    Random random{8};
    int beyond_two = 0;
    for (int i = 0; i < draws; ++i) {
        beyond_two += std::abs(random.normal()) > 2 ? 1 : 0;
    }
    const double share = std::erfc(2 / std::sqrt(2.0));
    EXPECT_NEAR(beyond_two, share * draws, 4 * std::sqrt(share * draws));
}

TEST(Random, UniformNumbersFillTheirIntervalEvenly) {
    Random random{9};
    std::array<int, 10> count{};
    for (int i = 0; i < draws; ++i) {
        const double x = random.uniform(-2, 3);
        ASSERT_GE(x, -2);
        ASSERT_LT(x, 3);
        ++count[static_cast<std::size_t>((x + 2) * 2)];
    }
    for (const int n : count) {
        EXPECT_NEAR(n, draws / 10, 4 * std::sqrt(draws / 10 * 0.9));
    }
}

TEST(Random, WholeNumbersBelowABoundComeEquallyOften) {
    Random random{10};
    std::array<int, 7> count{};
    for (int i = 0; i < draws; ++i) {
        ++count.at(random.below(7));
    }
    for (const int n : count) {
        EXPECT_NEAR(n, draws / 7, 4 * std::sqrt(draws / 7));
    }
    EXPECT_EQ(random.below(1), 0U);
}

TEST(Random, SeedsOfDifferentNumbersDiffer) {
    std::set<std::uint64_t> seeds{seed_of({}), seed_of({1, 0}), seed_of({0, 1, 0})};
    for (std::uint64_t way = 0; way < 100; ++way) {
        for (std::uint64_t direction = 0; direction < 2; ++direction) {
            seeds.insert(seed_of({42, way, direction}));
        }
    }
    EXPECT_EQ(seeds.size(), 203U);
}

} // namespace
} // namespace macadam::testing
