#include "mapping/analysis/worst_sections.hpp"

#include "mapping/analysis/maximum_scoring_runs.hpp"
#include "mapping/network/build_network.hpp"
#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace macadam {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::road_art;
using testing::RoadArt;
using ::testing::SizeIs;

constexpr double border = 2.683;
constexpr double cut_m = 0.5; // the drawing's own rounding of 200 m

/// Roads of the drawing with names, and no pass yet.
RoadNetwork named(const RoadArt& art, const std::vector<std::string>& names) {
    auto ways = art.ways;
    for (std::size_t i = 0; i < ways.size(); ++i) {
        ways[i].name = names[i];
        ways[i].highway = "residential";
    }
    return build_network(std::move(ways), 20);
}

/// One road of 400 m (20 segments), from west to east.
RoadNetwork one_road() {
    return named(road_art("A----------------------------------------B", 400.0 / 41, {"AB"}),
                 {"Long Road"});
}

SegmentRecord
record_of(const RoadNetwork& roads, const Segment& segment, double iri, std::int32_t passes = 3) {
    std::uint32_t number = 0;
    while (way_at(roads, number).id != segment.key.way_id) {
        ++number;
    }
    const auto way = way_at(roads, number);
    SegmentState state{};
    state.segment = segment.key;
    state.iri_um = static_cast<IriUm>(std::lround(iri * 1000));
    state.sd_um = 400;
    state.passes = passes;
    state.vehicles = 2;
    return {segment, std::string{way.name}, std::string{way.highway}, state};
}

/// What `iri` says of every segment in one direction of a way, by the number along the way;
/// negative: nobody drove it.
template <typename Iri>
std::vector<SegmentRecord>
driven(const RoadNetwork& roads, std::int64_t way_id, bool forward, Iri iri) {
    std::vector<SegmentRecord> records;
    for (std::uint32_t link = 0; link < link_count(roads); ++link) {
        for (const auto& segment : segments_of(roads, edge_of(LinkId{link}, forward))) {
            const double value = iri(segment.key.index);
            if (segment.key.way_id == way_id && value >= 0) {
                records.push_back(record_of(roads, segment, value));
            }
        }
    }
    return records;
}

std::vector<SegmentRecord> operator+(std::vector<SegmentRecord> a,
                                     const std::vector<SegmentRecord>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

const auto poor_everywhere = [](std::uint32_t) { return 4.0; };

TEST(WorstSections, AreNeighbouringPoorSegmentsInOnePiece) {
    const auto roads = one_road();
    const auto measured = driven(
        roads, 1, true, [](std::uint32_t i) { return i >= 5 && i < 12 ? 3.0 + 0.1 * i : 1.5; });
    const auto stretches = worst_sections(roads, measured, {});
    ASSERT_THAT(stretches, SizeIs(1));
    const auto& stretch = stretches[0];
    EXPECT_EQ(stretch.name, "Long Road");
    EXPECT_NEAR(stretch.length_m, 140, cut_m);
    EXPECT_NEAR(stretch.mean.iri, 3.8, 1e-9); // 3.5, 3.6, ..., 4.1 of one length
    EXPECT_EQ(stretch.worst_iri, 4.1);
    ASSERT_THAT(stretch.parts, SizeIs(1));
    EXPECT_NEAR(stretch.parts[0].from_m, 100, cut_m);
    EXPECT_NEAR(stretch.parts[0].to_m, 240, cut_m);
    EXPECT_THAT(stretch.records, ElementsAre(5, 6, 7, 8, 9, 10, 11));
}

TEST(WorstSections, HaveTheIntervalOfAMeanWhoseErrorIsHalfCommon) {
    const auto roads = one_road();
    const auto stretches = worst_sections(roads, driven(roads, 1, true, poor_everywhere), {});
    ASSERT_THAT(stretches, SizeIs(1));
    // 20 readings of sd 0.4: half of the variance is shared, half averages out.
    const double sd = std::sqrt(0.5 * 0.16 + 0.5 * 0.16 / 20);
    EXPECT_NEAR(stretches[0].mean.sd, sd, 1e-9);
    EXPECT_NEAR(stretches[0].mean.low, 4 - 1.645 * sd, 1e-9);
    EXPECT_NEAR(stretches[0].mean.high, 4 + 1.645 * sd, 1e-9);
}

TEST(WorstSections, AreLeftOutBelowTheLeastLength) {
    const auto roads = one_road();
    const auto measured =
        driven(roads, 1, true, [](std::uint32_t i) { return i >= 5 && i < 9 ? 9.0 : 1.5; });
    EXPECT_THAT(worst_sections(roads, measured, {}), IsEmpty());
    EXPECT_THAT(worst_sections(roads, measured, {.min_length_m = 60}), SizeIs(1));
}

TEST(WorstSections, BridgeOneSegmentThatNobodyDroveButNotTwo) {
    const auto roads = one_road();
    const auto with_gap = [&](std::uint32_t gap) {
        return worst_sections(
            roads,
            driven(roads,
                   1,
                   true,
                   [gap](std::uint32_t i) { return i >= 8 && i < 8 + gap ? -1.0 : 4.0; }),
            {});
    };
    ASSERT_THAT(with_gap(1), SizeIs(1));
    EXPECT_NEAR(with_gap(1)[0].length_m, 400, cut_m);
    EXPECT_NEAR(with_gap(1)[0].mean.length_m, 380, cut_m);
    EXPECT_THAT(with_gap(2), SizeIs(2));
}

TEST(WorstSections, BridgeABetterSegmentOnlyWhileBothSidesStayPoorWithIt) {
    const auto roads = one_road();
    const auto around = [&](double better) {
        return worst_sections(roads,
                              driven(roads,
                                     1,
                                     true,
                                     [better](std::uint32_t i) {
                                         return i == 9 ? better : i == 10 ? 2.8 : 3.0;
                                     }),
                              {});
    };
    EXPECT_THAT(around(2.0), SizeIs(1)); // 0.683 lost, more than 2 gained on either side
    EXPECT_THAT(around(-0.0), SizeIs(1));
    const auto long_better =
        driven(roads, 1, true, [](std::uint32_t i) { return i >= 9 && i < 12 ? 2.6 : 9.0; });
    EXPECT_THAT(worst_sections(roads, long_better, {}), SizeIs(2)); // 60 m of fair road
    const auto weak = driven(
        roads, 1, true, [](std::uint32_t i) { return i == 9 ? 0.0 : 2.9; }); // 9 * 0.217 < 2.683
    EXPECT_THAT(worst_sections(roads, weak, {}), SizeIs(2));
}

TEST(WorstSections, ComeWorstFirst) {
    const auto roads = one_road();
    const auto measured = driven(roads, 1, true, [](std::uint32_t i) {
        return i < 6 ? 3.0 : i < 10 ? 1.0 : i < 16 ? 5.0 : 1.0;
    });
    const auto stretches = worst_sections(roads, measured, {});
    ASSERT_THAT(stretches, SizeIs(2));
    EXPECT_NEAR(stretches[0].mean.iri, 5, 1e-9);
    EXPECT_NEAR(stretches[1].mean.iri, 3, 1e-9);
}

TEST(WorstSections, KeepTheDirectionsApart) {
    const auto roads = one_road();
    const auto measured =
        driven(roads, 1, true, poor_everywhere) +
        driven(roads, 1, false, [](std::uint32_t i) { return i < 10 ? 6.0 : 1.0; });
    const auto stretches = worst_sections(roads, measured, {});
    ASSERT_THAT(stretches, SizeIs(2));
    const auto& back = stretches[0];
    EXPECT_FALSE(back.parts[0].forward);
    EXPECT_NEAR(back.parts[0].from_m, 0, cut_m); // along the way, whatever the driving direction
    EXPECT_NEAR(back.parts[0].to_m, 200, cut_m);
    EXPECT_GT(back.line.front().lon_deg, back.line.back().lon_deg); // driven to the west
}

// A street in two ways (the second drawn from its far end), and one that crosses between.
const char* const crossing = R"(
              X
              |
              |
    A---------B---------C
              |
              |
              Y
)";

TEST(WorstSections, GoOnInAnotherWayOfTheSameName) {
    const auto roads =
        named(road_art(crossing, 10, {"AB", "CB", "XBY"}), {"High Street", "High Street", "Lane"});
    const auto measured =
        driven(roads, 1, true, poor_everywhere) + driven(roads, 2, false, poor_everywhere);
    const auto stretches = worst_sections(roads, measured, {});
    ASSERT_THAT(stretches, SizeIs(1));
    ASSERT_THAT(stretches[0].parts, SizeIs(2));
    EXPECT_EQ(stretches[0].parts[0].way_id, 1);
    EXPECT_TRUE(stretches[0].parts[0].forward);
    EXPECT_EQ(stretches[0].parts[1].way_id, 2);
    EXPECT_FALSE(stretches[0].parts[1].forward);
    EXPECT_NEAR(stretches[0].length_m, 200, cut_m);
}

TEST(WorstSections, EndWhereTheRoadTakesAnotherName) {
    const auto roads =
        named(road_art(crossing, 10, {"AB", "CB", "XBY"}), {"High Street", "Low Street", "Lane"});
    const auto measured =
        driven(roads, 1, true, poor_everywhere) + driven(roads, 2, false, poor_everywhere);
    EXPECT_THAT(worst_sections(roads, measured, {.min_length_m = 90}), SizeIs(2));
}

TEST(WorstSections, CrossAJunctionAlongTheirWay) {
    const auto roads = named(road_art(crossing, 10, {"ABC", "XB", "BY"}), {"", "", ""});
    const auto stretches = worst_sections(roads, driven(roads, 1, true, poor_everywhere), {});
    ASSERT_THAT(stretches, SizeIs(1));
    EXPECT_NEAR(stretches[0].length_m, 200, cut_m);
}

TEST(WorstSections, TurnIntoNoSideStreetOfTheSameName) {
    const auto roads = named(road_art(crossing, 10, {"AB", "BY"}), {"Estate", "Estate"});
    const auto measured =
        driven(roads, 1, true, poor_everywhere) + driven(roads, 2, true, poor_everywhere);
    EXPECT_THAT(worst_sections(roads, measured, {.min_length_m = 0}), SizeIs(2));
}

TEST(WorstSections, GoOnceRoundARing) {
    const auto roads = named(road_art(R"(
        A----------B
        |          |
        |          |
        D----------C
    )",
                                      10,
                                      {"ABCDA"}),
                             {"Ring"});
    const auto stretches = worst_sections(roads, driven(roads, 1, true, poor_everywhere), {});
    ASSERT_THAT(stretches, SizeIs(1));
    EXPECT_NEAR(stretches[0].length_m, 2 * (110 + 60), 2 * cut_m);
}

TEST(WorstSections, SayTheLeastAndTheMiddleOfThePasses) {
    const auto roads = one_road();
    auto measured = driven(roads, 1, true, [](std::uint32_t i) { return i < 6 ? 4.0 : -1.0; });
    const std::vector<std::int32_t> passes{9, 1, 4, 7, 2, 8};
    for (std::size_t i = 0; i < measured.size(); ++i) {
        measured[i].state->passes = passes[i];
        measured[i].state->first_seen_ms =
            i == 3 ? std::optional<std::int64_t>{5000} : std::nullopt;
        measured[i].state->last_seen_ms = static_cast<std::int64_t>(6000 + i);
    }
    const auto stretches = worst_sections(roads, measured, {});
    ASSERT_THAT(stretches, SizeIs(1));
    EXPECT_EQ(stretches[0].min_passes, 1);
    EXPECT_EQ(stretches[0].median_passes, 5.5); // of 1 2 4 7 8 9
    EXPECT_EQ(stretches[0].first_seen_ms, 5000);
    EXPECT_EQ(stretches[0].last_seen_ms, 6005);
}

TEST(WorstSections, DoNotDependOnTheOrderOfTheSegments) {
    const auto roads = one_road();
    auto measured =
        driven(roads, 1, true, [](std::uint32_t i) { return i % 7 == 3 ? 1.0 : 3.0 + 0.01 * i; });
    const auto before = worst_sections(roads, measured, {.min_length_m = 0});
    std::ranges::shuffle(measured, std::mt19937{5});
    const auto after = worst_sections(roads, measured, {.min_length_m = 0});
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_EQ(before[i].mean.iri, after[i].mean.iri);
        EXPECT_EQ(before[i].line, after[i].line);
    }
}

TEST(PoorAbove, IsTheUpperBorderOfTheMiddleClass) {
    EXPECT_NEAR(poor_above(*class_table("fhwa")), border, 1e-3);
    EXPECT_EQ(poor_above(*class_table("five")), 3.5);
}

// ----------------------------------------------------------------------------------- MaximalRuns

/// By its definition, in cubic time: ranges whose every beginning and end is positive, and that no
/// larger such range holds.
std::vector<IndexRange> runs_by_definition(const std::vector<double>& scores) {
    const auto is_run = [&](std::size_t first, std::size_t last) {
        double from_front = 0, from_back = 0;
        for (std::size_t i = 0; i < last - first; ++i) {
            from_front += scores[first + i];
            from_back += scores[last - 1 - i];
            if (from_front <= 0 || from_back <= 0) {
                return false;
            }
        }
        return true;
    };
    std::vector<IndexRange> all;
    for (std::size_t first = 0; first < scores.size(); ++first) {
        for (std::size_t last = first + 1; last <= scores.size(); ++last) {
            if (is_run(first, last)) {
                all.push_back({first, last});
            }
        }
    }
    std::vector<IndexRange> largest;
    std::ranges::copy_if(all, std::back_inserter(largest), [&](const IndexRange& a) {
        return std::ranges::none_of(all, [&](const IndexRange& b) {
            return b != a && b.first <= a.first && a.last <= b.last;
        });
    });
    return largest;
}

TEST(MaximalRuns, AreThoseOfTheirDefinition) {
    std::mt19937 random{11};
    for (int round = 0; round < 300; ++round) {
        std::vector<double> scores(random() % 24);
        for (auto& score : scores) {
            score = static_cast<double>(random() % 13) - 7; // whole numbers: sums are exact
        }
        EXPECT_EQ(maximal_scoring_runs(scores), runs_by_definition(scores)) << "round " << round;
    }
}

TEST(MaximalRuns, OfNothingPositiveAreNone) {
    EXPECT_THAT(maximal_scoring_runs(std::vector<double>{-1, 0, -2}), IsEmpty());
}

} // namespace
} // namespace macadam
