// Matched filters held beside the shapes that they are for.

#include "estimator/events/event_templates.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam::testing {
namespace {

constexpr double step_m = 0.25;
constexpr std::size_t stations = 80;

EventTemplate longest(EventShape shape) {
    EventTemplate best{.shape = shape, .length_m = -1, .change = {}};
    for (const auto& one : event_templates(step_m)) {
        best = one.shape == shape && one.length_m > best.length_m ? one : best;
    }
    return best;
}

/// A profile that is the template's shape of a size, from a station on.
std::vector<float> profile_with(const EventTemplate& shape, double size_m, std::size_t from) {
    std::vector<float> profile_m(stations);
    double height_m = 0;
    for (std::size_t i = 1; i < stations; ++i) {
        if (i > from && i <= from + shape.change.size()) {
            height_m += size_m * shape.change[i - from - 1];
        }
        profile_m[i] = static_cast<float>(height_m);
    }
    return profile_m;
}

} // namespace

TEST(EventTemplates, AreOfEveryShape) {
    for (const auto shape : {EventShape::dip, EventShape::raise, EventShape::step}) {
        EXPECT_GE(longest(shape).length_m, 0);
    }
}

TEST(EventTemplates, MeasureTheSizeOfTheirOwnShape) {
    const auto templates = event_templates(step_m);
    ASSERT_FALSE(templates.empty());
    for (const auto& shape : templates) {
        const auto profile_m = profile_with(shape, 0.03, 20);
        EXPECT_NEAR(template_sizes(shape, profile_m)[20], 0.03, 1e-6); // floats
    }
}

TEST(EventTemplates, EndAtTheLevelTheyBeginAtUnlessTheyAreSteps) {
    const auto templates = event_templates(step_m);
    ASSERT_FALSE(templates.empty());
    for (const auto& shape : templates) {
        double sum = 0;
        for (const double change : shape.change) {
            sum += change;
        }
        EXPECT_NEAR(sum, shape.shape == EventShape::step ? 1 : 0, 1e-12);
    }
}

TEST(EventTemplates, SeeTheDepthOfAHoleOfTheirLength) {
    const auto dip = longest(EventShape::dip);
    std::vector<float> profile_m(stations);
    for (std::size_t i = 0; i < stations; ++i) {
        const double part = (step_m * static_cast<double>(i) - 9.25) / dip.length_m;
        const bool within = part > 0 && part < 1;
        profile_m[i] =
            within ? static_cast<float>(-0.02 * (0.5 - 0.5 * std::cos(2 * std::numbers::pi * part)))
                   : 0.0F;
    }
    // The template is averaged over 0.25 m, the hole is not: 4 %.
    EXPECT_NEAR(std::ranges::max(template_sizes(dip, profile_m)), 0.02, 0.001);
}

TEST(EventTemplates, AnEdgeAloneHasOneHalfOfAHole) {
    const auto dip = longest(EventShape::dip);
    const auto hole_m = profile_with(dip, 0.03, 20);
    EXPECT_NEAR(smaller_half(dip, hole_m, 20), 0.03, 1e-6);
    auto edge_m = hole_m;
    const auto lowest = std::ranges::min_element(edge_m);
    std::fill(lowest, edge_m.end(), *lowest);
    EXPECT_LT(smaller_half(dip, edge_m, 20), 0.001);
}

TEST(EventTemplates, AreZeroWhereTheyWouldReachBeyondTheEnd) {
    const auto dip = longest(EventShape::dip);
    std::vector<float> profile_m(dip.change.size());
    EXPECT_THAT(template_sizes(dip, profile_m), ::testing::Each(0.0));
    EXPECT_THAT(template_sizes(dip, {}), ::testing::IsEmpty());
}

} // namespace macadam::testing
