#include "mapping/network/build_network.hpp"
#include "mapping/network/road_network.hpp"

#include "estimator/common/error.hpp"
#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

namespace macadam {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Way way(std::int64_t id, std::vector<std::int64_t> node_ids, std::vector<GeoPoint> line) {
    return {id, "", "", Oneway::no, std::move(node_ids), std::move(line)};
}

/// Points 0.001 degrees of latitude (111 m) apart, to the north.
std::vector<GeoPoint> northward(std::size_t count, double lon_deg = 10, double lat_deg = 50) {
    std::vector<GeoPoint> line;
    for (std::size_t i = 0; i < count; ++i) {
        line.push_back({lat_deg + 0.001 * static_cast<double>(i), lon_deg});
    }
    return line;
}

TEST(RoadNetwork, CutsAWayWhereAnotherMeetsIt) {
    const auto art = testing::road_art(R"(
        A----B----C
             |
             D
    )",
                                       10,
                                       {"ABC", "BD"});
    EXPECT_EQ(link_count(art.roads), 3U);
    EXPECT_EQ(node_count(art.roads), 4U);
}

TEST(RoadNetwork, KeepsAwayFromTheAntimeridian) {
    for (const double lon_deg : {179.95, 180.0, -179.95}) {
        try {
            build_network({way(5, {1, 2, 3}, northward(3, lon_deg))});
            FAIL() << lon_deg;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr("way '5' reaches longitude "));
            EXPECT_THAT(error.what(),
                        HasSubstr("expected roads at least 0.1 degrees from the antimeridian"));
        }
    }
    EXPECT_EQ(link_count(build_network({way(5, {1, 2}, northward(2, 179.8))})), 1U);
}

TEST(RoadNetwork, KeepsBendsWithinALink) {
    const auto roads = build_network({way(1, {1, 2, 3, 4}, northward(4))});
    ASSERT_EQ(link_count(roads), 1U);
    EXPECT_THAT(line_of(roads, EdgeId{0}), SizeIs(4));
}

TEST(RoadNetwork, OfAClosedWayHasItsFirstPointAsNode) {
    const auto roads =
        build_network({way(1, {1, 2, 3, 1}, {{50, 10}, {50.001, 10}, {50.001, 10.001}, {50, 10}})});
    ASSERT_EQ(link_count(roads), 1U);
    EXPECT_EQ(link_at(roads, LinkId{0}).from, link_at(roads, LinkId{0}).to);
}

TEST(RoadNetwork, CutsAWayThatMeetsItself) {
    const auto roads = build_network(
        {way(1,
             {1, 2, 3, 4, 2},
             {{50, 10}, {50.001, 10}, {50.002, 10}, {50.002, 10.001}, {50.001, 10}})});
    EXPECT_EQ(link_count(roads), 2U);
}

TEST(RoadNetwork, ToleratesARepeatedPoint) {
    const auto roads = build_network({way(1, {1, 1, 2}, {{50, 10}, {50, 10}, {50.001, 10}})});
    ASSERT_EQ(link_count(roads), 1U);
    EXPECT_THAT(way_at(roads, 0).node_ids, ElementsAre(1, 2));
}

TEST(RoadNetwork, LeavesOutAWayThatIsAPoint) {
    EXPECT_EQ(way_count(build_network({way(1, {1, 2}, {{50, 10}, {50, 10}})})), 0U);
}

TEST(RoadNetwork, RefusesAWayIdThatStandsTwice) {
    try {
        build_network({way(17, {1, 2}, northward(2)), way(17, {3, 4}, northward(2))});
        FAIL() << "expected a refusal";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("way '17' occurs twice in the network"));
    }
}

TEST(RoadNetwork, RefusesASegmentLengthThatIsNone) {
    EXPECT_THROW(build_network({}, 0), InputError);
}

TEST(RoadNetwork, NumbersSegmentsAlongTheWay) {
    // 3 x 111.2 m; a branch after the first 111.2 m: round(111.2/20) = 6, round(222.5/20) = 11.
    const auto roads = build_network(
        {way(1, {1, 2, 3, 4}, northward(4)), way(2, {2, 9}, {{50.001, 10}, {50, 11}})});
    EXPECT_EQ(link_at(roads, LinkId{0}).segments, 6u);
    EXPECT_EQ(link_at(roads, LinkId{1}).first_segment, 6u);
    EXPECT_EQ(link_at(roads, LinkId{1}).segments, 11u);
}

TEST(RoadNetwork, GivesEvenAShortLinkOneSegment) {
    const auto roads = build_network({way(1, {1, 2}, {{50, 10}, {50.00001, 10}})});
    EXPECT_EQ(link_at(roads, LinkId{0}).segments, 1u);
}

TEST(RoadNetwork, LetsNobodyLeaveAgainstAOneway) {
    const auto art = testing::road_art(R"(
        A----B
    )",
                                       10,
                                       {"AB>"});
    const auto edge = testing::edge_between(art, 'A', 'B');
    EXPECT_TRUE(is_drivable(art.roads, edge));
    EXPECT_FALSE(is_drivable(art.roads, reversed(edge)));
    EXPECT_THAT(out_edges(art.roads, to_node(art.roads, edge)), IsEmpty());
    EXPECT_THAT(out_edges(art.roads, from_node(art.roads, edge)), ElementsAre(edge));
}

TEST(RoadNetwork, IsTheSameWhateverTheOrderOfTheWays) {
    auto art = testing::road_art(R"(
        A----B----C
        |    |    |
        D----E----F
    )",
                                 10,
                                 {"ABC", "DEF", "AD", "BE", "CF"});
    std::reverse(art.ways.begin(), art.ways.end());
    const auto other = build_network(art.ways);
    ASSERT_EQ(node_count(other), node_count(art.roads));
    for (std::uint32_t i = 0; i < node_count(other); ++i) {
        EXPECT_EQ(place_of(other, NodeId{i}), place_of(art.roads, NodeId{i}));
    }
    EXPECT_THAT(drivable_edges(other), ElementsAreArray(drivable_edges(art.roads)));
    ASSERT_EQ(link_count(other), link_count(art.roads));
    for (std::uint32_t i = 0; i < link_count(other); ++i) {
        EXPECT_EQ(link_at(other, LinkId{i}).from, link_at(art.roads, LinkId{i}).from);
        EXPECT_EQ(link_at(other, LinkId{i}).way, link_at(art.roads, LinkId{i}).way);
    }
}

TEST(RoadNetwork, MeasuresBackwardOffsetsFromTheOtherEnd) {
    const auto roads = build_network({way(1, {1, 2, 3}, northward(3))});
    const double whole_m = length_m(roads, LinkId{0});
    const auto forward = place_on(roads, edge_of(LinkId{0}, true), 40);
    const auto backward = place_on(roads, edge_of(LinkId{0}, false), whole_m - 40);
    EXPECT_NEAR(distance_m(forward, backward), 0, 1e-6); // rounding
    EXPECT_NEAR(distance_m({50, 10}, forward), 40, 1e-3);
}

TEST(RoadNetwork, HoldsPlacesBeyondAnEdgeAtItsEnds) {
    const auto roads = build_network({way(1, {1, 2}, northward(2))});
    EXPECT_EQ(place_on(roads, EdgeId{0}, -5), (GeoPoint{50, 10}));
    EXPECT_EQ(place_on(roads, EdgeId{0}, 5000), (GeoPoint{50.001, 10}));
}

/// Random short ways in a box, and every link that a small box meets by going through all.
class LinksNear : public ::testing::TestWithParam<double> {};

TEST_P(LinksNear, MissesNoLinkThatABruteSearchFinds) {
    std::mt19937_64 random{7};
    std::uniform_real_distribution<double> place{0, 0.1};
    std::uniform_real_distribution<double> step{-0.01, 0.01};
    std::vector<Way> ways;
    for (int i = 0; i < 300; ++i) {
        const GeoPoint a{GetParam() + place(random), 20 + place(random)};
        const GeoPoint b{a.lat_deg + step(random), a.lon_deg + step(random)};
        ways.push_back(way(i, {2 * i, 2 * i + 1}, {a, b}));
    }
    const auto roads = build_network(ways);
    for (int i = 0; i < 200; ++i) {
        const GeoPoint at{GetParam() + place(random), 20 + place(random)};
        const auto box = grown(including({}, at), 120);
        const auto found = links_near(roads, box);
        EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
        for (std::uint32_t link = 0; link < link_count(roads); ++link) {
            const auto line = line_of(roads, edge_of(LinkId{link}, true));
            bool meets = false;
            for (int k = 0; k <= 1000 && !meets; ++k) {
                meets = contains(box, between(line.front(), line.back(), k / 1000.0));
            }
            EXPECT_TRUE(!meets || std::binary_search(found.begin(), found.end(), LinkId{link}));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(AtLatitudes, LinksNear, ::testing::Values(-33.0, 0.0, 50.0, 70.0));

TEST(LinksNearBox, IsEmptyFarFromEveryRoad) {
    const auto roads = build_network({way(1, {1, 2}, northward(2))});
    EXPECT_THAT(links_near(roads, grown(including({}, {51, 10}), 1000)), IsEmpty());
}

TEST(LinksNearBox, GivesALinkOfManyCellsOnce) {
    const auto roads = build_network({way(1, {1, 2}, {{50, 10}, {50.5, 10.5}})});
    EXPECT_THAT(links_near(roads, {9, 49, 11, 51}), ElementsAre(LinkId{0}));
}

} // namespace
} // namespace macadam
