// The same as likelihood_accuracy_test.cpp with a hundred cars, some ten minutes: ./run test --all.

#include "likelihood_runs.hpp"

#include <gtest/gtest.h>

namespace macadam::testing {
namespace {

TEST(LikelihoodFitOfAHundredCars, HoldsTheTruthInItsIntervalsAndReadsOtherRoadsWithinThreePercent) {
    const auto report = report_of_runs(100);
    print(report);
    ASSERT_EQ(report.parameters.size(), 11U);
    for (const auto& [name, count] : report.parameters) {
        EXPECT_GE(count.inside, 90U) << name;
    }
    EXPECT_LE(report.found.rms(), 0.03);
}

} // namespace
} // namespace macadam::testing
