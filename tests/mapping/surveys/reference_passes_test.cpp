// From rows of a survey to passes over segments.

#include "mapping/surveys/reference_passes.hpp"

#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace macadam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;
using ::testing::SizeIs;

/// Way 1, 200 m in ten segments of 20 m both ways, goes on in way 2, 100 m and oneway; way 3 runs
/// beside them, 100 m to the south.
const RoadArt& roads() {
    static const auto art = road_art(R"(
        A---------B----C




        D---------E----F
    )",
                                     20,
                                     {"AB", "BC>", "DEF"});
    return art;
}

ReferenceRow
on_way(std::int64_t way_id, double from_m, double to_m, double mri, bool forward = true) {
    ReferenceRow row;
    row.values.mri_mm_per_m = mri;
    row.way = WayPart{way_id, forward, from_m, to_m};
    return row;
}

ReferenceSurvey by_ways(std::vector<ReferenceRow> rows) {
    return {ReferenceLocation::on_ways, std::move(rows), "hash"};
}

ReferencePasses passes_of(const ReferenceSurvey& survey, const ReferenceConfig& config = {}) {
    return reference_passes(survey, placed_on(roads().roads, survey), config);
}

/// The length of way 1, about 200 m: the drawing's metres are not quite the ellipsoid's.
double whole_m() {
    return link_at(roads().roads, LinkId{0}).to_m;
}

double segment_m() {
    return whole_m() / 10;
}

TEST(ReferencePasses, AreTheMeansOfRowsByLength) {
    const double s = segment_m();
    // A quarter, a half and a quarter of the first segment; all of the second.
    const auto found = passes_of(by_ways({on_way(1, 0, s / 4, 1),
                                          on_way(1, s / 4, 0.75 * s, 2),
                                          on_way(1, 0.75 * s, s, 4),
                                          on_way(1, s, 2 * s, 3)}));
    ASSERT_THAT(found.passes, SizeIs(2));
    EXPECT_EQ(found.passes[0].segment, (SegmentKey{1, true, 0}));
    EXPECT_EQ(found.passes[0].iri_um, 2250);
    EXPECT_EQ(found.passes[1].iri_um, 3000);
    EXPECT_EQ(found.passes[1].sd_um, 90); // rows within their segment: the stated 3 % alone
    EXPECT_NEAR(found.passes[1].covered_mm, 1000 * s, 1);
    EXPECT_EQ(found.used, 4U);
    EXPECT_TRUE(found.reasons.empty());
}

TEST(ReferencePasses, OfLongRowsStateTheRoadsOwnScatter) {
    const double s = segment_m();
    const auto found = passes_of(by_ways({on_way(1, 0, 5 * s, 2)}), {.relative_sd = 0.04});
    ASSERT_THAT(found.passes, SizeIs(5));
    for (const auto& pass : found.passes) {
        EXPECT_EQ(pass.iri_um, 2000);
        EXPECT_NEAR(pass.sd_um, 2000 * std::hypot(0.04, 0.28 * std::sqrt(1 - 0.2)), 1);
    }
    EXPECT_NEAR(found.row_m, 5 * s, 1e-6);
}

TEST(ReferencePasses, NeedHalfOfASegment) {
    const double s = segment_m();
    const auto found = passes_of(by_ways({on_way(1, 0, 0.45 * s, 2), on_way(1, s, 1.55 * s, 2)}));
    ASSERT_THAT(found.passes, SizeIs(1));
    EXPECT_EQ(found.passes[0].segment.index, 1U);
    // What is not covered may be otherwise.
    EXPECT_NEAR(found.passes[0].sd_um, 2000 * std::hypot(0.03, 0.28 * std::sqrt(0.45)), 1);
    EXPECT_THAT(found.reasons, ElementsAre(Pair("short_part", 1U)));
}

TEST(ReferencePasses, CountAnotherRunAsAnotherOccurrence) {
    const double s = segment_m();
    const auto found = passes_of(by_ways(
        {on_way(1, 0, s, 2), on_way(1, s, 2 * s, 2), on_way(1, 0, s, 3), on_way(1, s, 2 * s, 3)}));
    ASSERT_THAT(found.passes, SizeIs(4));
    EXPECT_EQ(found.passes[1].segment.index, 0U);
    EXPECT_EQ(found.passes[1].occurrence, 1U);
    EXPECT_EQ(found.passes[1].iri_um, 3000);
}

TEST(ReferencePasses, KeepTracksWhereAllRowsHaveThem) {
    const double s = segment_m();
    auto rows =
        std::vector{on_way(1, 0, s, 2), on_way(1, s, 1.5 * s, 2), on_way(1, 1.5 * s, 2 * s, 2)};
    for (const std::size_t row : {0, 1}) {
        rows[row].values.left_mm_per_m = 1.8;
        rows[row].values.right_mm_per_m = 2.2;
    }
    const auto found = passes_of(by_ways(rows));
    ASSERT_THAT(found.passes, SizeIs(2));
    EXPECT_EQ(found.passes[0].iri_left_um, 1800);
    EXPECT_EQ(found.passes[0].iri_right_um, 2200);
    EXPECT_EQ(found.passes[1].iri_left_um, std::nullopt);
}

TEST(ReferencePasses, InferMriFromHriAndSayThatTheyAreLessSure) {
    ReferenceRow row;
    row.values.hri_mm_per_m = 1.82;
    row.way = WayPart{1, true, 0, segment_m()};
    const auto found = passes_of(by_ways({row}));
    ASSERT_THAT(found.passes, SizeIs(1));
    EXPECT_EQ(found.passes[0].iri_um, 2000); // 1.82 / 0.91
    EXPECT_TRUE(found.passes[0].centre_only);
    EXPECT_NEAR(found.passes[0].sd_um, 2000 * std::hypot(0.03, 0.055 / 0.91), 1);
}

TEST(ReferencePasses, AccountForEveryRow) {
    ReferenceRow nowhere;
    nowhere.placed = false;
    nowhere.values.mri_mm_per_m = 2;
    auto silent = on_way(1, 0, 20, 2);
    silent.values.mri_mm_per_m.reset();
    auto one_track = silent;
    one_track.values.left_mm_per_m = 2;
    const auto found = passes_of(by_ways({nowhere,
                                          silent,
                                          one_track,
                                          on_way(9, 0, 20, 2),
                                          on_way(1, 500, 520, 2),
                                          on_way(2, 0, 20, 2, false),
                                          on_way(2, 0, 20, 2)}));
    EXPECT_THAT(found.reasons,
                ElementsAre(Pair("beyond_way", 1U),
                            Pair("no_iri", 1U),
                            Pair("no_place", 1U),
                            Pair("no_such_way", 1U),
                            Pair("not_drivable", 1U),
                            Pair("one_track", 1U)));
    EXPECT_EQ(found.used, 1U);
}

// ----------------------------------------------------------------------------- by coordinates

/// The middles of `count` rows of equal length on the way from one letter to another.
std::vector<ReferenceRow> middles(char from, char to, int count) {
    std::vector<ReferenceRow> rows;
    const auto& a = roads().places.at(from);
    const auto& b = roads().places.at(to);
    for (int i = 0; i < count; ++i) {
        ReferenceRow row;
        row.values.at = between(a, b, (i + 0.5) / count);
        row.values.length_m = distance_m(a, b) / count;
        row.values.mri_mm_per_m = 1 + i;
        rows.push_back(row);
    }
    return rows;
}

/// Most of the way; a match may lose its ends.
void expect_all_of_way_1(const ReferencePasses& found, bool forward, bool rising) {
    ASSERT_GE(found.passes.size(), 9U);
    for (const auto& pass : found.passes) {
        EXPECT_EQ(pass.segment.way_id, 1);
        EXPECT_EQ(pass.segment.forward, forward);
        const auto number = rising ? pass.segment.index : 9 - pass.segment.index;
        // Of a neighbour that differs by 1000 the match's metre brings in a twentieth.
        EXPECT_NEAR(pass.iri_um, 1000 * (1 + static_cast<int>(number)), 150);
    }
}

TEST(ReferencePasses, FollowTheDirectionInWhichMiddlesWereDriven) {
    expect_all_of_way_1(
        passes_of({ReferenceLocation::middles, middles('A', 'B', 10), ""}), true, true);
    expect_all_of_way_1(
        passes_of({ReferenceLocation::middles, middles('B', 'A', 10), ""}), false, false);
}

TEST(ReferencePasses, LetHeadingsDecideWhateverTheOrderOfTheFile) {
    for (const bool against : {false, true}) {
        auto rows = middles('A', 'B', 10);
        for (auto& row : rows) {
            row.heading_deg = 90; // the drawing runs east
        }
        if (against) {
            std::ranges::reverse(rows);
        }
        expect_all_of_way_1(passes_of({ReferenceLocation::middles, rows, ""}), true, true);
    }
}

TEST(ReferencePasses, LieBetweenTheEndsOfTheirRows) {
    auto rows = middles('B', 'A', 10);
    const auto& a = roads().places.at('B');
    const auto& b = roads().places.at('A');
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].begin = between(a, b, static_cast<double>(i) / 10);
        rows[i].end = between(a, b, static_cast<double>(i + 1) / 10);
        rows[i].values.at = {};
    }
    expect_all_of_way_1(passes_of({ReferenceLocation::ends, rows, ""}), false, false);
}

TEST(ReferencePasses, AreNoneOffTheNetwork) {
    auto rows = middles('A', 'B', 10);
    for (auto& row : rows) {
        row.values.at.lat_deg += 0.02; // 2 km north
    }
    const auto found = passes_of({ReferenceLocation::middles, rows, ""});
    EXPECT_TRUE(found.passes.empty());
    EXPECT_THAT(found.reasons, ElementsAre(Pair("off_network", 10U)));
}

TEST(ReferencePasses, NeedANeighbourOrAHeading) {
    auto rows = middles('A', 'B', 10);
    const auto found = passes_of({ReferenceLocation::middles, {rows[4]}, ""});
    EXPECT_THAT(found.reasons, ElementsAre(Pair("no_neighbour", 1U)));
}

} // namespace
} // namespace macadam::testing
