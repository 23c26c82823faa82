#include "estimator/live/monotonic_gate.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace macadam::testing {
namespace {

using ::testing::ElementsAre;

/// The times that are let through, of samples that are their own times.
std::vector<double> let_through(const std::vector<double>& times_s) {
    MonotonicGate<double> gate;
    std::vector<double> passed;
    for (const double t_s : times_s) {
        gate.add(t_s, t_s, [&](double sample) { passed.push_back(sample); });
    }
    return passed;
}

} // namespace

TEST(MonotonicGate, LetsRisingTimesThrough) {
    EXPECT_THAT(let_through({0, 0.1, 0.2, 0.3}), ElementsAre(0, 0.1, 0.2, 0.3));
}

TEST(MonotonicGate, DropsWhatDoesNotRise) {
    EXPECT_THAT(let_through({0, 0.1, 0.1, 0.05, 0.2}), ElementsAre(0, 0.1, 0.2));
}

TEST(MonotonicGate, LetsAWildStampCostItselfOnly) {
    EXPECT_THAT(let_through({0, 0.1, 1e9, 0.2, 0.3}), ElementsAre(0, 0.1, 0.2, 0.3));
}

TEST(MonotonicGate, LetsAWildFirstStampCostItselfOnly) {
    EXPECT_THAT(let_through({1e9, 0, 0.1, 0.2}), ElementsAre(0, 0.1, 0.2));
}

TEST(MonotonicGate, GoesOnAfterAPause) {
    EXPECT_THAT(let_through({0, 0.1, 100, 100.1, 100.2}), ElementsAre(0, 0.1, 100, 100.1, 100.2));
}

TEST(MonotonicGate, TakesASlowSensorForWhatItIs) {
    // The first two steps wait for the one behind them, then the sensor's own pace is known.
    EXPECT_THAT(let_through({0, 5, 10, 15, 20}), ElementsAre(0, 5, 10, 15, 20));
}

TEST(MonotonicGate, CountsWhatItDrops) {
    MonotonicGate<int> gate;
    for (const double t_s : {0.0, 0.1, 1e9, 0.2, 0.2, 0.3}) {
        gate.add(t_s, 0, [](int) {});
    }
    EXPECT_EQ(gate.dropped(), 2U);
}

} // namespace macadam::testing
