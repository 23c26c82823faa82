#include "mapping/alignment/alignment.hpp"

#include "support/roads/roughness_pattern.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace macadam {
namespace {

using testing::read_pattern;
using testing::Reading;

std::function<double(double)> always(double lag_m) {
    return [lag_m](double) { return lag_m; };
}

Reading over_chunk(double lag_m, std::uint64_t seed) {
    return {.from_m = 20, .to_m = 480, .lag_m = always(lag_m), .seed = seed};
}

std::vector<LagLine> lags(const std::vector<RoughnessTrace>& traces) {
    return lags_of(traces, {});
}

std::vector<RoughnessTrace> read_with(const std::vector<double>& pattern,
                                      const std::vector<double>& lags_m) {
    std::vector<RoughnessTrace> traces;
    for (const double lag : lags_m) {
        traces.push_back(read_pattern(pattern, over_chunk(lag, 100 + traces.size())));
    }
    return traces;
}

/// The shift of `b` against `a` that gives the highest correlation of the logarithms, by trying
/// each decimetre.
double brute_force_lag_m(const RoughnessTrace& a, const RoughnessTrace& b) {
    const auto value = [](const RoughnessTrace& trace, double index) {
        const auto i = static_cast<std::size_t>(index);
        const double before = std::log(1.0 + *um_of(trace.iri[i]));
        const double after = std::log(1.0 + *um_of(trace.iri[i + 1]));
        return std::lerp(before, after, index - static_cast<double>(i));
    };
    double best = -1;
    double best_lag_m = 0;
    for (double lag = -10; lag <= 10; lag += 0.1) {
        double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
        for (double i = 12; i < static_cast<double>(a.iri.size()) - 12; ++i) {
            // Both between samples alike, so that interpolation smooths them alike.
            const double x = value(a, i - lag / 2), y = value(b, i + lag / 2);
            ++n, sa += x, sb += y, saa += x * x, sbb += y * y, sab += x * y;
        }
        const double r = (n * sab - sa * sb) / std::sqrt((n * saa - sa * sa) * (n * sbb - sb * sb));
        if (r > best) {
            best = r;
            best_lag_m = lag;
        }
    }
    return best_lag_m;
}

/// Over the chunk.
double mean_lag_m(const LagLine& line) {
    double sum_m = 0;
    int count = 0;
    for (double at_m = 20; at_m < 480; at_m += 10) {
        sum_m += lag_m(line, at_m);
        ++count;
    }
    return sum_m / count;
}

// What a third of noise in each metre leaves of the lag of 460 m, and of one place: the scatter of
// about a hundred metres.
constexpr double near_m = 0.25;
constexpr double near_here_m = 1;

TEST(Alignment, LeavesASingleTraceWhereItWas) {
    EXPECT_EQ(lags(read_with(testing::roughness_pattern(500, 1), {4})), std::vector<LagLine>(1));
    EXPECT_TRUE(lags({}).empty());
}

TEST(Alignment, OfTwoAlikeMeetsHalfWay) {
    for (const double lag : {-8.0, -3.3, 0.6, 5.0}) {
        const auto found = lags(read_with(testing::roughness_pattern(500, 2), {0, lag}));
        EXPECT_NEAR(mean_lag_m(found[1]) - mean_lag_m(found[0]), lag, near_m);
        for (double at_m = 20; at_m < 480; at_m += 20) {
            EXPECT_NEAR(lag_m(found[1], at_m) - lag_m(found[0], at_m), lag, near_here_m);
            EXPECT_NEAR(lag_m(found[1], at_m) + lag_m(found[0], at_m), 0, 0.1);
        }
    }
}

TEST(Alignment, FindsTheLagThatTryingThemAllFinds) {
    for (std::uint64_t seed = 3; seed < 9; ++seed) {
        const auto traces =
            read_with(testing::roughness_pattern(500, seed), {0, -6.5 + 2.0 * double(seed - 3)});
        const auto found = lags(traces);
        EXPECT_NEAR(mean_lag_m(found[1]) - mean_lag_m(found[0]),
                    brute_force_lag_m(traces[0], traces[1]),
                    2 * near_m + 0.1) // each is off in its own way; of the trials' spacing
            << seed;
    }
}

TEST(Alignment, LetsTheMoreAccurateHoldTheDatum) {
    const auto pattern = testing::roughness_pattern(500, 4);
    auto sure = over_chunk(0, 1);
    sure.place_sd_m = 1;
    auto unsure = over_chunk(5, 2);
    unsure.place_sd_m = 3;
    const auto found = lags({read_pattern(pattern, sure), read_pattern(pattern, unsure)});
    // The lags' mean under weights 1 and 1/9 is 0 and their difference 5.
    EXPECT_NEAR(mean_lag_m(found[0]), -0.5, 0.1 * near_m + 0.01);
    EXPECT_NEAR(mean_lag_m(found[1]), 4.5, near_m);
}

TEST(Alignment, FollowsALagThatChangesAlongTheChunk) {
    const auto pattern = testing::roughness_pattern(500, 5);
    auto drifting = over_chunk(0, 2);
    drifting.lag_m = [](double station_m) { return 2 * std::sin(station_m / 120); };
    const auto found =
        lags({read_pattern(pattern, over_chunk(0, 1)), read_pattern(pattern, drifting)});
    for (double at_m = 40; at_m < 460; at_m += 10) {
        const double between_m = lag_m(found[1], at_m) - lag_m(found[0], at_m);
        // A stretch of 100 m tells the lag less surely than the whole, and the walk that ties them
        // rounds off the turns.
        EXPECT_NEAR(between_m, drifting.lag_m(at_m), 0.6) << at_m;
    }
}

TEST(Alignment, DoesNotMindGainOrSpeed) {
    const auto pattern = testing::roughness_pattern(500, 6);
    auto loud = over_chunk(-4, 2);
    const auto quiet = loud;
    loud.gain = 9;
    const auto first = read_pattern(pattern, over_chunk(0, 1));
    const auto with_loud = lags({first, read_pattern(pattern, loud)});
    const auto with_quiet = lags({first, read_pattern(pattern, quiet)});
    EXPECT_NEAR(mean_lag_m(with_loud[1]), mean_lag_m(with_quiet[1]), 0.05); // codes are rounded
}

TEST(Alignment, BringsManyTracesTogether) {
    const auto pattern = testing::roughness_pattern(500, 7);
    std::mt19937_64 random{7};
    std::normal_distribution<double> place{0, 3};
    std::vector<double> drawn_m;
    for (int i = 0; i < 12; ++i) {
        drawn_m.push_back(std::clamp(place(random), -7.0, 7.0));
    }
    const auto found = lags(read_with(pattern, drawn_m));
    ASSERT_EQ(found.size(), drawn_m.size());
    for (std::size_t i = 1; i < found.size(); ++i) {
        EXPECT_NEAR(mean_lag_m(found[i]) - mean_lag_m(found[0]), drawn_m[i] - drawn_m[0], near_m);
    }
}

TEST(Alignment, LeavesTracesWithNothingInCommonWhereTheyWere) {
    int moved = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        std::vector<RoughnessTrace> traces;
        for (std::uint64_t i = 0; i < 3; ++i) {
            traces.push_back(read_pattern(testing::roughness_pattern(500, 1000 + 3 * seed + i),
                                          over_chunk(0, i)));
        }
        for (const auto& line : lags(traces)) {
            moved += std::abs(mean_lag_m(line)) > 1 ? 1 : 0;
        }
    }
    EXPECT_LE(moved, 4); // of 120: what the best of 21 lags gets from noise is discounted
}

TEST(Alignment, OfAnEvenRoadIsNone) {
    const std::vector<double> even(5000, 1.0);
    auto quiet = over_chunk(3, 1);
    quiet.noise = 0;
    const auto trace = read_pattern(even, quiet);
    EXPECT_EQ(lags({trace, trace, trace}), std::vector<LagLine>(3));
}

TEST(Alignment, IsNotMovedByABrokenTrace) {
    const auto sound = read_with(testing::roughness_pattern(500, 8), {0, 3, -2, 1});
    const auto without = lags(sound);
    int moved = 0;
    for (std::uint64_t seed = 50; seed < 90; ++seed) {
        const auto place = static_cast<std::ptrdiff_t>(seed % 5);
        auto traces = sound;
        traces.insert(traces.begin() + place,
                      read_pattern(testing::roughness_pattern(500, seed), over_chunk(0, 5)));
        auto with = lags(traces);
        moved += std::abs(mean_lag_m(with[static_cast<std::size_t>(place)])) > 1 ? 1 : 0;
        with.erase(with.begin() + place);
        for (std::size_t i = 0; i < sound.size(); ++i) {
            EXPECT_NEAR(mean_lag_m(with[i]), mean_lag_m(without[i]), 0.3) << seed;
        }
    }
    EXPECT_LE(moved, 2); // of 40: what chance makes of three standard deviations
}

TEST(Alignment, HardlyDependsOnTheOrderOfTraces) {
    auto traces = read_with(testing::roughness_pattern(500, 9), {0, 4, -5, 2, -1});
    const auto found = lags(traces);
    std::ranges::reverse(traces);
    auto turned = lags(traces);
    std::ranges::reverse(turned);
    ASSERT_EQ(found.size(), 5U);
    ASSERT_EQ(turned.size(), 5U);
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(mean_lag_m(turned[i]), mean_lag_m(found[i]), 0.1);
    }
}

TEST(Alignment, WorksWhereDrivesCoverOnlyParts) {
    const auto pattern = testing::roughness_pattern(500, 10);
    auto first_part = over_chunk(4, 2);
    first_part.to_m = 160;
    auto last_part = over_chunk(-3, 3);
    last_part.from_m = 330;
    auto traces = std::vector{read_pattern(pattern, over_chunk(0, 1)),
                              read_pattern(pattern, first_part),
                              read_pattern(pattern, last_part)};
    std::fill_n(traces[0].iri.begin() + 200, 60, no_roughness); // a silence
    const auto found = lags(traces);
    EXPECT_NEAR(lag_m(found[1], 90) - lag_m(found[0], 90), 4, 2 * near_m);
    EXPECT_NEAR(lag_m(found[2], 400) - lag_m(found[0], 400), -3, 2 * near_m);
}

TEST(Alignment, NeverGoesBeyondTenMetres) {
    const auto found = lags(read_with(testing::roughness_pattern(500, 11), {0, 9, -9}));
    ASSERT_EQ(found.size(), 3U);
    for (const auto& line : found) {
        ASSERT_FALSE(line.lag_cm.empty());
        for (const auto cm : line.lag_cm) {
            EXPECT_LE(std::abs(cm), 1000);
        }
    }
    for (const double lag : {-30.0, -11.0, 12.0, 40.0}) { // left where they are
        const auto far = lags(read_with(testing::roughness_pattern(500, 11), {0, lag, -lag}));
        ASSERT_EQ(far.size(), 3U);
        for (const auto& line : far) {
            EXPECT_TRUE(line.lag_cm.empty()) << lag;
        }
    }
}

TEST(Alignment, OfADriveFartherOffThanItLooksIsNone) {
    const auto pattern = testing::roughness_pattern(500, 13);
    const auto with_fourth = [&](double lag_m) {
        auto traces = read_with(pattern, {0, 0, 0});
        auto fourth = over_chunk(lag_m, 104);
        fourth.place_sd_m = 30; // its place alone would not keep it from the border
        traces.push_back(read_pattern(pattern, fourth));
        return lags(traces);
    };
    const auto near = with_fourth(9);
    EXPECT_EQ(near[3].finding, LagStatus::found);
    EXPECT_NEAR(
        mean_lag_m(near[3]), 9, 3 * near_m); // sums hold the datum of four by the sure three
    for (const double lag : {10.2, -10.2, 10.6}) {
        const auto far = with_fourth(lag);
        EXPECT_EQ(far[3].finding, LagStatus::beyond_reach) << lag;
        EXPECT_TRUE(far[3].lag_cm.empty()) << lag;
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_EQ(far[i].finding, LagStatus::found) << lag;
            EXPECT_NEAR(mean_lag_m(far[i]), 0, near_m) << lag;
        }
    }
}

TEST(Alignment, SaysWhatItFound) {
    EXPECT_EQ(lags(read_with(testing::roughness_pattern(500, 14), {0}))[0].finding,
              LagStatus::alone);
    const auto found = lags(read_with(testing::roughness_pattern(500, 14), {0, 3}));
    EXPECT_EQ(found[0].finding, LagStatus::found);
    EXPECT_EQ(found[1].finding, LagStatus::found);
}

/// Without a function of the C library, which may differ in the last bit.
std::vector<RoughnessTrace> whole_number_traces(const std::vector<int>& lags_m) {
    std::mt19937 random{15};
    std::vector<unsigned> pattern;
    for (int i = 0; i < 520; ++i) {
        pattern.push_back(random() % 32);
    }
    std::vector<RoughnessTrace> traces;
    for (const int lag : lags_m) {
        RoughnessTrace trace{.chunk = {1, true, 0},
                             .drive = 0,
                             .first_m = 0,
                             .iri = {},
                             .left = {},
                             .place_sd_mm = 2000 + 300 * static_cast<int>(traces.size())};
        for (int i = 0; i < 480; ++i) {
            const auto at = pattern.begin() + 15 + i - lag;
            const auto sum = std::accumulate(at, at + 5, 0U) / 2 + random() % 16;
            trace.iri.push_back(static_cast<RoughnessCode>(60 + sum));
        }
        traces.push_back(trace);
    }
    return traces;
}

TEST(Alignment, ComesToTheSameCentimetresOnEveryMachine) {
    // As they came out on a 64-bit x86 without fused operations. Another processor, compiler or
    // way of putting sums in vectors must come to the same.
    const auto found = lags(whole_number_traces({0, 4, -5, 2, -1}));
    ASSERT_EQ(found.size(), 5U);
    EXPECT_EQ(found[0].lag_cm,
              (std::vector<std::int32_t>{-6, -21, -36, -33, -33, -28, -26, -23, -20, -9}));
    EXPECT_EQ(
        found[2].lag_cm,
        (std::vector<std::int32_t>{-519, -515, -501, -522, -515, -497, -511, -515, -501, -529}));
}

TEST(Alignment, TakesTracesOfAMetre) {
    const RoughnessTrace metre{.chunk = {1, true, 0},
                               .drive = 0,
                               .first_m = -3,
                               .iri = {code_of(2)},
                               .left = {},
                               .place_sd_mm = 1};
    EXPECT_EQ(lags({metre, metre}), std::vector<LagLine>(2));
    const auto far_off = read_pattern(testing::roughness_pattern(500, 12), over_chunk(0, 1));
    EXPECT_EQ(lags({metre, far_off}), std::vector<LagLine>(2));
}

TEST(LagLine, IsStraightBetweenMiddlesOfBlocksAndHeldBeyond) {
    const LagLine line{.first_block = -1, .lag_cm = {100, 300, 0}};
    EXPECT_DOUBLE_EQ(lag_m(line, -25), 1);
    EXPECT_DOUBLE_EQ(lag_m(line, 0), 2);
    EXPECT_DOUBLE_EQ(lag_m(line, 25), 3);
    EXPECT_DOUBLE_EQ(lag_m(line, 60), 0.9);
    EXPECT_DOUBLE_EQ(lag_m(line, -400), 1);
    EXPECT_DOUBLE_EQ(lag_m(line, 4000), 0);
    EXPECT_DOUBLE_EQ(lag_m({}, 10), 0);
    EXPECT_DOUBLE_EQ(lag_m({.first_block = 2, .lag_cm = {-70}}, 10), -0.7);
}

} // namespace
} // namespace macadam
