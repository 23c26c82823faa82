#include "render/report/comparison/comparison_page.hpp"

#include "render/report/comparison/agreement_figure.hpp"
#include "render/report/report.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <variant>

using namespace macadam;
using namespace macadam::document;
using ::testing::HasSubstr;
using ::testing::Not;

namespace {

/// Differences 0.1 and 0.3 in turn, on 100 roads: bias 0.2, sd 0.1005.
std::vector<AgreementPair> sample_pairs() {
    std::vector<AgreementPair> pairs;
    for (int i = 0; i < 100; ++i) {
        const double b = 1 + 0.03 * i;
        pairs.push_back({{i, true, 0}, b + (i % 2 == 0 ? 0.1 : 0.3), b});
    }
    return pairs;
}

SourceComparison sample_comparison() {
    SourceComparison comparison;
    comparison.a = {"roads.gpkg", "road database", ""};
    comparison.b = {"laser<1>.csv", "survey", ""};
    comparison.pairs = sample_pairs();
    comparison.all = agreement_of(comparison.pairs);
    comparison.shared = SharedSegments{2.0, 3, 4, 0};
    comparison.groups.push_back({"Road class", {{"primary", comparison.all}}});
    return comparison;
}

template <typename Kind>
std::vector<Kind> shapes_of(const Drawing& drawing) {
    std::vector<Kind> shapes;
    for (const auto& shape : drawing.shapes) {
        if (const auto* const found = std::get_if<Kind>(&shape)) {
            shapes.push_back(*found);
        }
    }
    return shapes;
}

} // namespace

TEST(ComparisonPage, TellsBiasAndLimitsOfAgreement) {
    const auto html = html_of(comparison_document(sample_comparison()));
    EXPECT_THAT(html, HasSubstr("roads.gpkg and laser&lt;1&gt;.csv"));
    EXPECT_THAT(html, HasSubstr("+0.20"));          // bias
    EXPECT_THAT(html, HasSubstr("±0.00 to +0.40")); // 0.2 -+ 1.96 * 0.1005
    EXPECT_THAT(html, HasSubstr("primary"));
    EXPECT_THAT(html, HasSubstr("3 segments are known to A alone, 4 to B alone"));
    EXPECT_THAT(html, Not(HasSubstr("nan")));
}

TEST(ComparisonPage, ShowsEveryPairWithinTheFrameAndThreeIntervals) {
    const auto pairs = sample_pairs();
    const auto figure = agreement_figure(pairs, agreement_of(pairs), Localisation{});
    EXPECT_EQ(figure.outside, 0U);
    const auto dots = shapes_of<Dots>(figure.drawing);
    ASSERT_EQ(dots.size(), 1U);
    EXPECT_EQ(dots[0].places.size(), 100U);
    for (const auto& [x, y] : dots[0].places) {
        EXPECT_TRUE(x >= 0 && x <= figure.drawing.width && y >= 0 && y <= figure.drawing.height);
    }
    EXPECT_EQ(shapes_of<Bar>(figure.drawing).size(), 3U);
}

TEST(ComparisonPage, LeavesRareFarDotsOutOfTheFrameAndCountsThem) {
    auto pairs = sample_pairs();
    for (std::int64_t i = 0; i < 900; ++i) {
        pairs.push_back({{1000 + i, true, 0}, 2.2, 2});
    }
    pairs[0].a = pairs[0].b + 50; // one of 1,000
    const auto figure = agreement_figure(pairs, agreement_of(pairs), Localisation{});
    EXPECT_EQ(figure.outside, 1U);
}

TEST(ComparisonPage, DrawsASinglePairWithoutLimits) {
    const std::vector<AgreementPair> pairs{{{1, true, 0}, 2, 2}};
    const auto figure = agreement_figure(pairs, agreement_of(pairs), Localisation{});
    EXPECT_EQ(shapes_of<Bar>(figure.drawing).size(), 0U);
    for (const auto& label : shapes_of<Label>(figure.drawing)) {
        EXPECT_TRUE(std::isfinite(label.x) && std::isfinite(label.y)) << label.text;
    }
}

TEST(ComparisonPage, SaysThatNothingIsShared) {
    auto comparison = sample_comparison();
    comparison.pairs.clear();
    comparison.all = agreement_of({});
    comparison.groups.clear();
    const auto html = html_of(comparison_document(comparison));
    EXPECT_THAT(html, HasSubstr("The sources have no segments in common."));
    EXPECT_THAT(html, Not(HasSubstr("nan")));
}

TEST(ComparisonPage, JudgesProfilesByTheThresholdsOfR56) {
    auto comparison = sample_comparison();
    comparison.shared.reset();
    comparison.groups.clear();
    TrackAgreement track{100, 2.0, 2.1, {}, {}};
    track.bands.push_back({profile_bands()[0], 0.91, 0.95, 0.96, -0.25});
    comparison.tracks.push_back({"left", track});
    const auto html = html_of(comparison_document(comparison));
    EXPECT_THAT(html, HasSubstr("0.910, is below the 0.92"));
    EXPECT_THAT(html, HasSubstr("meets the 0.90"));
    EXPECT_THAT(html, HasSubstr("−0.25"));
}
