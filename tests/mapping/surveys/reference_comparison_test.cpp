// The statistics of cars beside references, against what the formulas say.

#include "mapping/surveys/reference_comparison.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace macadam::testing {
namespace {

using ::testing::SizeIs;

constexpr std::int64_t day_ms = 86'400'000;

ReferencedSegment
segment(std::uint32_t index, IriUm reference_um, IriUm cars_um, IriUm sd_um = 100) {
    ReferencedSegment one{};
    const SegmentKey key{7, true, index};
    one.segment = {key, 20.0 * index, 20.0 * (index + 1), {}};
    one.reference.segment = key;
    one.reference.iri_um = reference_um;
    one.reference.sd_um = reference_um / 50;
    one.cars.segment = key;
    one.cars.iri_um = cars_um;
    one.cars.sd_um = sd_um;
    one.cars.low_um = cars_um - 2 * sd_um;
    one.cars.high_um = cars_um + 2 * sd_um;
    one.cars.passes = 3;
    return one;
}

TEST(ReferenceComparison, HasBiasRmseCorrelationAndCoverageOfSegments) {
    // Errors +0.1, +0.3, -0.1, +0.1 mm/m, the second beyond its interval.
    const std::vector segments{segment(0, 1000, 1100),
                               segment(1, 2000, 2300),
                               segment(2, 3000, 2900),
                               segment(3, 4000, 4100)};
    const auto scores = reference_scores(pairs_of(segment_pairs(segments), ComparedSide::headline));
    EXPECT_EQ(scores.all.pieces, 4U);
    EXPECT_NEAR(scores.all.bias, 0.1, 1e-12);
    EXPECT_NEAR(scores.all.rmse, std::sqrt((0.01 + 0.09 + 0.01 + 0.01) / 4), 1e-12);
    EXPECT_NEAR(scores.all.coverage, 0.75, 1e-12);
    // Sums about the means 2.5 and 2.6: 5, 4.68 and 4.8.
    EXPECT_NEAR(scores.all.correlation, 4.8 / std::sqrt(5 * 4.68), 1e-12);
}

TEST(ReferenceComparison, TellsLevelsOfOneMillimetreAMetreApart) {
    const std::vector segments{segment(0, 1000, 1100),
                               segment(1, 1999, 1999),
                               segment(2, 2000, 2500),
                               segment(3, 7500, 7000)};
    const auto scores = reference_scores(pairs_of(segment_pairs(segments), ComparedSide::headline));
    ASSERT_THAT(scores.by_level, SizeIs(3));
    EXPECT_EQ(scores.by_level[0].pieces, 2U);
    EXPECT_EQ(scores.by_level[0].from_mm_per_m, 1);
    EXPECT_EQ(scores.by_level[1].from_mm_per_m, 2);
    EXPECT_NEAR(scores.by_level[1].bias, 0.5, 1e-12);
    EXPECT_EQ(scores.by_level[2].from_mm_per_m, 7);
    EXPECT_EQ(scores.by_level[2].to_mm_per_m, 8);
}

TEST(ReferenceComparison, AveragesAHundredMetresBeforeItCompares) {
    std::vector<ReferencedSegment> segments;
    for (std::uint32_t i = 0; i < 11; ++i) {
        segments.push_back(segment(i, 2000, i % 2 == 0 ? 2400 : 1600));
    }
    const auto pairs = hundred_metre_pairs(segments, 20);
    ASSERT_THAT(pairs, SizeIs(2)); // the eleventh is left over
    EXPECT_NEAR(pairs[0].length_m, 100, 1e-9);
    EXPECT_NEAR(pairs[0].headline.survey, 2, 1e-12);
    EXPECT_NEAR(pairs[0].headline.trip, (3 * 2.4 + 2 * 1.6) / 5, 1e-12);
    EXPECT_NEAR(pairs[1].headline.trip, (2 * 2.4 + 3 * 1.6) / 5, 1e-12);
    EXPECT_EQ(pairs[0].first.index, 0U);
    EXPECT_EQ(pairs[0].last.index, 4U);
    // Narrower than one segment's, wider than of five that are independent.
    const double reach = pairs[0].headline.high - pairs[0].headline.trip;
    EXPECT_LT(reach, 1.645 * 0.1);
    EXPECT_GT(reach, 1.645 * 0.1 / std::sqrt(5.0));
}

TEST(ReferenceComparison, BreaksHundredMetresWhereRoadOrSurveyDoNotGoOn) {
    std::vector<ReferencedSegment> segments;
    for (const std::uint32_t i : {0, 1, 2, 3, 5, 6, 7, 8, 9}) {
        segments.push_back(segment(i, 2000, 2000));
    }
    EXPECT_THAT(hundred_metre_pairs(segments, 20), SizeIs(1)); // 5 to 9
    segments[8].survey = 1;
    EXPECT_THAT(hundred_metre_pairs(segments, 20), SizeIs(0));
}

TEST(ReferenceComparison, TakesTracksOnlyWhereBothKnowThem) {
    auto both = segment(0, 2000, 2000);
    both.reference.iri_left_um = 1800;
    both.reference.iri_right_um = 2200;
    auto cars_alone = both;
    both.cars.left_um = 1900;
    both.cars.right_um = 2100;
    cars_alone.reference.iri_left_um.reset();
    const auto pairs = segment_pairs(std::vector{both, cars_alone});
    const auto left = reference_scores(pairs_of(pairs, ComparedSide::left));
    EXPECT_EQ(left.all.pieces, 1U);
    EXPECT_NEAR(left.all.bias, 0.1, 1e-12);
    EXPECT_TRUE(std::isnan(left.all.coverage)); // a track has no interval
    EXPECT_NEAR(reference_scores(pairs_of(pairs, ComparedSide::right)).all.bias, -0.1, 1e-12);
}

TEST(ReferenceComparison, SaysHowMuchLaterTheCarsWereThere) {
    auto one = segment(0, 2000, 2000);
    EXPECT_EQ(segment_pairs({&one, 1})[0].days_after, std::nullopt);
    one.reference_utc_ms = 30 * day_ms;
    one.cars.last_seen_ms = 10 * day_ms;
    EXPECT_EQ(segment_pairs({&one, 1})[0].days_after, -20);
}

} // namespace
} // namespace macadam::testing
