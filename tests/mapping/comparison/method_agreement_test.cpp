#include "mapping/comparison/method_agreement.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <random>

using namespace macadam;
using ::testing::ElementsAre;
using ::testing::Field;

namespace {

/// Pairs on segments of one road.
std::vector<AgreementPair> pairs_on_a_road(std::span<const double> a, std::span<const double> b) {
    std::vector<AgreementPair> pairs;
    for (std::size_t i = 0; i < a.size(); ++i) {
        pairs.push_back({{1, true, static_cast<std::uint32_t>(i)}, a[i], b[i]});
    }
    return pairs;
}

/// Pairs on a way each, whose differences are independent.
std::vector<AgreementPair> pairs_apart(std::span<const double> a, std::span<const double> b) {
    auto pairs = pairs_on_a_road(a, b);
    for (auto& pair : pairs) {
        pair.segment = {pair.segment.index, true, 0};
    }
    return pairs;
}

} // namespace

TEST(MethodAgreement, IsThatOfBlandAndAltmansPeakFlowMeters) {
    // Table 1 of the paper of 1986, l/min: large and mini Wright peak flow meter, 17 persons.
    constexpr std::array<double, 17> large{
        494, 395, 516, 434, 476, 557, 413, 442, 650, 433, 417, 656, 267, 478, 178, 423, 427};
    constexpr std::array<double, 17> mini{
        512, 430, 520, 428, 500, 600, 364, 380, 658, 445, 432, 626, 260, 477, 259, 350, 451};
    const auto agreement = agreement_of(pairs_apart(large, mini));
    const auto& difference = agreement.difference;
    EXPECT_EQ(agreement.pairs, 17U);
    EXPECT_DOUBLE_EQ(difference.independent, 17);
    // As printed, with one decimal.
    EXPECT_NEAR(difference.bias.value, -2.1, 0.05);
    EXPECT_NEAR(difference.sd, 38.8, 0.05);
    EXPECT_NEAR(difference.bias.low, -22.0, 0.1);
    EXPECT_NEAR(difference.bias.high, 17.8, 0.1);
    // The paper rounds 1.96 to 2 and 2.92 to 3: 1.6 for the limits, 0.4 more for their intervals.
    EXPECT_NEAR(difference.lower.value, -79.7, 1.7);
    EXPECT_NEAR(difference.upper.value, 75.5, 1.7);
    EXPECT_NEAR(difference.lower.low, -114.3, 2.1);
    EXPECT_NEAR(difference.lower.high, -45.1, 2.1);
    EXPECT_NEAR(difference.upper.low, 40.9, 2.1);
    EXPECT_NEAR(difference.upper.high, 110.1, 2.1);
}

TEST(MethodAgreement, RelatesDifferencesToTheMeanOfBoth) {
    constexpr std::array<double, 3> a{1.1, 2.2, 4.4};
    constexpr std::array<double, 3> b{0.9, 1.8, 3.6};
    const auto agreement = agreement_of(pairs_apart(a, b));
    EXPECT_NEAR(agreement.relative.bias.value, 20, 1e-9);
    EXPECT_NEAR(agreement.relative.sd, 0, 1e-9);
    EXPECT_NEAR(agreement.relative.upper.high, 20, 1e-6);
    EXPECT_NEAR(agreement.difference.bias.value, (0.2 + 0.4 + 0.8) / 3, 1e-12);
}

TEST(MethodAgreement, CountsCorrelatedNeighboursForFewer) {
    // Differences of first-order autoregression with correlation r: n (1 - r) / (1 + r) effective
    // ones for the mean of a long road.
    constexpr double r = 0.8;
    constexpr std::size_t count = 40000;
    std::mt19937_64 random{7};
    std::normal_distribution<double> normal;
    std::vector<double> a(count), b(count, 2.0);
    double error = 0;
    for (auto& value : a) {
        error = r * error + std::sqrt(1 - r * r) * normal(random);
        value = 2 + error;
    }
    const auto along = agreement_of(pairs_on_a_road(a, b)).difference;
    const double expected = count * (1 - r) / (1 + r);
    // The scatter of the estimated correlations, 50 of them of about 1/sqrt(n) each.
    EXPECT_NEAR(along.independent / expected, 1, 0.15);
    const auto apart = agreement_of(pairs_apart(a, b)).difference;
    EXPECT_DOUBLE_EQ(apart.independent, count);
    EXPECT_DOUBLE_EQ(apart.sd, along.sd);
    EXPECT_NEAR((along.bias.high - along.bias.low) / (apart.bias.high - apart.bias.low),
                std::sqrt((1 + r) / (1 - r)),
                0.25);
    EXPECT_GT(along.upper.high - along.upper.low, apart.upper.high - apart.upper.low);
}

TEST(MethodAgreement, IntervalsOfCorrelatedRoadsHoldTheTruthAsOftenAsTheySay) {
    constexpr double r = 0.7;
    constexpr int worlds = 400;
    std::mt19937_64 random{11};
    std::normal_distribution<double> normal;
    int bias_held = 0, limit_held = 0;
    for (int world = 0; world < worlds; ++world) {
        std::vector<double> a(500), b(500, 3.0);
        double error = normal(random);
        for (auto& value : a) {
            error = r * error + std::sqrt(1 - r * r) * normal(random);
            value = 3.5 + error;
        }
        const auto difference = agreement_of(pairs_on_a_road(a, b)).difference;
        bias_held += difference.bias.low <= 0.5 && 0.5 <= difference.bias.high ? 1 : 0;
        const double limit = 0.5 + 1.96;
        limit_held += difference.upper.low <= limit && limit <= difference.upper.high ? 1 : 0;
    }
    // 95 % of 400 with a standard deviation of 1.1 %; correlations estimated from one road are
    // known to be somewhat low. Without them, about 70 % hold it.
    EXPECT_GT(bias_held, 0.90 * worlds);
    EXPECT_GT(limit_held, 0.90 * worlds);
}

TEST(MethodAgreement, HasNoIntervalOfTooFewPairs) {
    EXPECT_EQ(agreement_of({}).pairs, 0U);
    EXPECT_TRUE(std::isnan(agreement_of({}).difference.bias.value));
    constexpr std::array<double, 2> a{1, 2};
    constexpr std::array<double, 2> b{1, 1};
    const auto one = agreement_of(pairs_apart(std::span{a}.first(1), std::span{b}.first(1)));
    EXPECT_EQ(one.difference.bias.value, 0);
    EXPECT_TRUE(std::isnan(one.difference.sd));
    const auto two = agreement_of(pairs_apart(a, b));
    EXPECT_NEAR(two.difference.sd, std::sqrt(0.5), 1e-12);
    EXPECT_TRUE(std::isnan(two.difference.upper.high));
}

TEST(MethodAgreement, OrdersGroupsByRankAndLeavesPairsWithoutGroupOut) {
    constexpr std::array<double, 4> a{1, 2, 3, 4};
    constexpr std::array<double, 4> b{0, 1, 2, 2};
    const std::array<GroupName, 4> names{
        GroupName{1, "fast"}, GroupName{0, "slow"}, GroupName{0, ""}, GroupName{1, "fast"}};
    const auto groups = agreement_by_group(pairs_apart(a, b), names);
    EXPECT_THAT(
        groups,
        ElementsAre(Field(&AgreementGroup::name, "slow"), Field(&AgreementGroup::name, "fast")));
    ASSERT_EQ(groups.size(), 2U);
    EXPECT_EQ(groups[1].agreement.pairs, 2U);
    EXPECT_NEAR(groups[1].agreement.difference.bias.value, 1.5, 1e-12);
}
