// The likelihood fit on cars that are not what their files say, over measured roads that they do
// not hit exactly, and what the identified cars make of other roads.

#include "estimator/smoother/bounds.hpp"
#include "likelihood_runs.hpp"

#include <gtest/gtest.h>

namespace macadam::testing {
namespace {

TEST(LikelihoodFit, HoldsTheTruthInItsIntervalsAndReadsOtherRoadsWithinThreePercent) {
    const auto report = report_of_runs(6); // a hundred: likelihood_long_test.cpp
    print(report);
    ASSERT_EQ(report.parameters.size(), 11U);
    for (const auto& [name, count] : report.parameters) {
        EXPECT_GE(count.inside, 4U) << name; // three or more of six outside: one in 500
        if (name != "ms_kg") {
            EXPECT_GE(count.inside_given_mass, 4U) << name;
        }
    }
    // The smoother itself reads these roads 3 % off with the true car.
    expect_at_most("HRI of other roads, rms error", report.found.rms(), {0.03, 0.04});
    expect_at_most("the same relative to the true car", report.found_to_truth.rms(), {0.03});
    EXPECT_LT(report.found.rms(), report.spectrum.rms());
    EXPECT_LT(report.found.rms(), report.file.rms());
}

} // namespace
} // namespace macadam::testing
