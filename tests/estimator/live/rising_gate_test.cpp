#include "estimator/live/rising_gate.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace macadam::testing {
namespace {

using ::testing::ElementsAre;

/// The times that are let through, of samples that are their own times.
std::vector<double> let_through(const std::vector<double>& times_s) {
    RisingGate<double> gate;
    std::vector<double> passed;
    for (const double t_s : times_s) {
        gate.add(t_s, t_s, [&](double sample) { passed.push_back(sample); });
    }
    return passed;
}

} // namespace

TEST(RisingGate, LetsRisingTimesThrough) {
    EXPECT_THAT(let_through({0, 0.1, 0.2, 0.3}), ElementsAre(0, 0.1, 0.2, 0.3));
}

TEST(RisingGate, DropsWhatDoesNotRise) {
    EXPECT_THAT(let_through({0, 0.1, 0.1, 0.05, 0.2}), ElementsAre(0, 0.1, 0.2));
}

TEST(RisingGate, LetsAWildStampCostItselfOnly) {
    EXPECT_THAT(let_through({0, 0.1, 1e9, 0.2, 0.3}), ElementsAre(0, 0.1, 0.2, 0.3));
}

TEST(RisingGate, LetsAWildFirstStampCostItselfOnly) {
    EXPECT_THAT(let_through({1e9, 0, 0.1, 0.2}), ElementsAre(0, 0.1, 0.2));
}

TEST(RisingGate, GoesOnAfterAPause) {
    EXPECT_THAT(let_through({0, 0.1, 100, 100.1, 100.2}), ElementsAre(0, 0.1, 100, 100.1, 100.2));
}

TEST(RisingGate, TakesASlowSensorForWhatItIs) {
    // The first two steps wait for the one behind them, then the sensor's own pace is known.
    EXPECT_THAT(let_through({0, 5, 10, 15, 20}), ElementsAre(0, 5, 10, 15, 20));
}

TEST(RisingGate, CountsWhatItDrops) {
    RisingGate<int> gate;
    for (const double t_s : {0.0, 0.1, 1e9, 0.2, 0.2, 0.3}) {
        gate.add(t_s, 0, [](int) {});
    }
    EXPECT_EQ(gate.dropped(), 2U);
}

} // namespace macadam::testing
