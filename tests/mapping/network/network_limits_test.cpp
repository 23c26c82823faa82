#include "mapping/network/build_network.hpp"

#include "estimator/common/error.hpp"
#include "mapping/network/segment.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace macadam {
namespace {

using ::testing::HasSubstr;

/// A way northwards from 48, 15 in steps of so many degrees, its nodes numbered from `first_node`.
Way straight(std::int64_t id, std::size_t points, double step_deg, std::int64_t first_node = 1) {
    Way way{.id = id, .name = "", .highway = "", .oneway = Oneway::no, .node_ids = {}, .line = {}};
    for (std::size_t i = 0; i < points; ++i) {
        way.node_ids.push_back(first_node + static_cast<std::int64_t>(i));
        way.line.push_back({48 + static_cast<double>(i) * step_deg, 15});
    }
    return way;
}

std::string
refusal_of(std::vector<Way> ways, const NetworkLimits& limits = {}, double segment_length_m = 20) {
    try {
        build_network(std::move(ways), segment_length_m, limits);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(NetworkLimits, LetALineHaveMorePointsThan262144) {
    constexpr std::size_t points = 270'000;
    const auto roads = build_network({straight(7, points, 1e-6)});
    ASSERT_EQ(link_count(roads), 1U);
    EXPECT_EQ(link_at(roads, LinkId{0}).last_point, points - 1);
    EXPECT_EQ(roads.tree.numbers.size(), (points - 1 + 15) / 16);
    // Each end and the middle are found by the index, and by nothing that lies elsewhere.
    for (const double lat_deg : {48.0, 48.135, 48.269999}) {
        EXPECT_EQ(links_near(roads, grown(including({}, {lat_deg, 15}), 1)).size(), 1U) << lat_deg;
    }
    EXPECT_TRUE(links_near(roads, grown(including({}, {48.3, 15}), 1)).empty());
}

TEST(NetworkLimits, AreToldInWordsWhereThereAreMorePoints) {
    EXPECT_THAT(refusal_of({straight(1, 10, 1e-4)}, {.points = 10}),
                HasSubstr("the roads have 10 points, expected fewer than 10"));
    EXPECT_EQ(refusal_of({straight(1, 10, 1e-4)}, {.points = 11}), "");
}

TEST(NetworkLimits, AreToldInWordsWhereNamesAreTooLong) {
    auto one = straight(1, 2, 1e-4);
    auto other = straight(2, 2, 1e-4, 2);
    one.name = other.name = "Ringstrasse"; // kept once
    EXPECT_EQ(refusal_of({one, other}, {.letters = 12}), "");
    other.name = "Ringweg";
    EXPECT_THAT(refusal_of({one, other}, {.letters = 12}),
                HasSubstr("names of the roads are too long"));
}

TEST(NetworkLimits, AreToldInWordsWhereThereAreMoreTurnRestrictions) {
    auto way = straight(1, 2, 1e-4);
    way.turns = {{2, 1, 0}, {2, 1, 1}};
    EXPECT_THAT(refusal_of({way}, {.turns = 2}),
                HasSubstr("the roads have 2 turn restrictions, expected fewer than 2"));
}

TEST(NetworkLimits, AreToldInWordsWhereFewPointsWouldMakeMillionsOfSegments) {
    // 36 degrees of latitude in 37 points: 4,000 km.
    EXPECT_THAT(
        refusal_of({straight(1, 37, 1)}, {.free_segments = 1000, .segments_per_point = 50}),
        HasSubstr("too long for their 37 points: they have more than 2850 segments of 20 m"));
    EXPECT_EQ(refusal_of({straight(1, 37, 1)}), "");
    EXPECT_THAT(refusal_of({straight(1, 37, 1)}, {}, 0.1), HasSubstr("a longer segment length"));
    EXPECT_THAT(refusal_of({straight(1, 37, 1)}, {}, 1e-300), HasSubstr("a longer segment length"));
}

TEST(NetworkLimits, CountSegmentsInBoundsWhateverTheLengths) {
    EXPECT_EQ(segments_in(4e6, 1e-300), std::numeric_limits<std::uint32_t>::max());
    EXPECT_EQ(segments_in(0, 20), 1U);
}

TEST(NetworkLimits, RefuseWhatIsNoPlace) {
    for (const double bad : {std::nan(""), HUGE_VAL, 90.1}) {
        auto way = straight(1, 3, 1e-4);
        way.line[1].lat_deg = bad;
        EXPECT_THAT(refusal_of({way}), HasSubstr("way '1' has the invalid position ")) << bad;
    }
    auto way = straight(1, 3, 1e-4);
    way.line[1].lon_deg = std::nan("");
    EXPECT_THAT(refusal_of({way}), HasSubstr("has the invalid position"));
}

TEST(NetworkLimits, KeepTurnRestrictionsOfANodeWithThousandsOfWaysFromGrowingBySquares) {
    std::vector<Way> ways;
    for (std::int64_t i = 1; i <= 3000; ++i) {
        ways.push_back({.id = i,
                        .name = "",
                        .highway = "",
                        .oneway = Oneway::no,
                        .node_ids = {0, i},
                        .line = {{48, 15}, {48.001, 15 + static_cast<double>(i) * 1e-6}},
                        .turns = {{0, i % 3000 + 1, 1}}});
    }
    EXPECT_TRUE(build_network(std::move(ways)).turn_restrictions.empty());
}

} // namespace
} // namespace macadam
