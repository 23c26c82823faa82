// The same as likelihood_accuracy_test.cpp with a hundred cars, some ten minutes: ./run test --all.

#include "estimator/smoother/bounds.hpp"
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
        if (name != "ms_kg") {
            EXPECT_GE(count.inside_given_mass, 90U) << name;
        }
    }
    // The smoother itself reads these roads 3 % off with the true car.
    expect_at_most("HRI of other roads, rms error", report.found.rms(), {0.03, 0.04});
    expect_at_most("the same relative to the true car", report.found_to_truth.rms(), {0.03});
}

} // namespace
} // namespace macadam::testing
