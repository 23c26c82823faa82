#include "mapping/network/build_network.hpp"
#include "mapping/network/road_network.hpp"

#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <random>

namespace macadam {
namespace {

using testing::edge_between;
using testing::road_art;

/// A crossing of four ways, numbered 1 to 4 from the west against the clock, that meet at X; and
/// way 5 that goes on from S.
class Crossing : public ::testing::Test {
protected:
    Crossing()
        : art_{road_art(R"(
                N
                |
           W----X----E
                |
                S----T
    )",
                        20,
                        {"WX", "SX", "XE", "XN", "ST"})} {}

    /// Whether one may go from the way of `from` over X into the way of `to`.
    bool may_go(char from, char to) const {
        return may_turn(roads_, edge_between(art_, from, 'X'), edge_between(art_, 'X', to));
    }
    void rule(std::size_t from_way, const TurnRule& turn) {
        art_.ways[from_way - 1].turns.push_back(turn);
        roads_ = build_network(art_.ways);
    }

    testing::RoadArt art_;
    RoadNetwork roads_;
};

TEST_F(Crossing, WithoutRulesLetsEveryTurnBe) {
    roads_ = art_.roads;
    for (const char from : {'W', 'S', 'E', 'N'}) {
        for (const char to : {'W', 'S', 'E', 'N'}) {
            EXPECT_TRUE(may_go(from, to)) << from << to;
        }
    }
}

TEST_F(Crossing, BarsTheTurnThatIsForbiddenAndNoOther) {
    rule(1, {'X', 4, 0});
    for (const char from : {'W', 'S', 'E', 'N'}) {
        for (const char to : {'W', 'S', 'E', 'N'}) {
            EXPECT_EQ(may_go(from, to), !(from == 'W' && to == 'N')) << from << to;
        }
    }
}

TEST_F(Crossing, LeavesOnlyTheTurnThatIsPrescribed) {
    rule(2, {'X', 3, 1});
    for (const char from : {'W', 'S', 'E', 'N'}) {
        for (const char to : {'W', 'S', 'E', 'N'}) {
            EXPECT_EQ(may_go(from, to), from != 'S' || to == 'E') << from << to;
        }
    }
}

TEST_F(Crossing, BarsTurningRoundWhereThatIsForbidden) {
    rule(3, {'X', 3, 0});
    EXPECT_FALSE(may_go('E', 'E'));
    EXPECT_TRUE(may_go('W', 'W'));
}

TEST_F(Crossing, PassesOverRulesThatAreNotPlain) {
    rule(1, {'S', 4, 0});  // way 1 does not come to S
    rule(1, {'Q', 4, 0});  // no such node
    rule(1, {'X', 99, 0}); // no such way
    rule(5, {'X', 4, 0});
    EXPECT_TRUE(may_go('W', 'N'));
    EXPECT_TRUE(may_go('S', 'N'));
}

TEST_F(Crossing, ObeysManyRulesAtOnce) {
    std::mt19937_64 random{5};
    const std::string ends = "WSEN"; // of ways 1 to 4
    std::map<std::pair<char, char>, bool> barred;
    for (int i = 0; i < 6; ++i) {
        const auto from = random() % 4;
        const auto to = random() % 4;
        rule(from + 1, {'X', static_cast<std::int64_t>(to + 1), 0});
        barred[{ends[from], ends[to]}] = true;
    }
    for (const char from : ends) {
        for (const char to : ends) {
            EXPECT_EQ(may_go(from, to), !barred.contains({from, to})) << from << to;
        }
    }
}

TEST(TurnRules, OfAWayThatPassesTheNodeAreNotPlain) {
    auto art = road_art(R"(
           W----X----E
                |
                S
    )",
                        20,
                        {"WXE", "XS"});
    art.ways[0].turns = {{'X', 2, 0}};
    const auto roads = build_network(art.ways);
    EXPECT_TRUE(may_turn(roads, edge_between(art, 'W', 'X'), edge_between(art, 'X', 'S')));
    EXPECT_TRUE(may_turn(roads, edge_between(art, 'E', 'X'), edge_between(art, 'X', 'S')));
}

TEST(TurnRules, OfAOnewayThatPassesTheNodeArePlain) {
    auto art = road_art(R"(
           W----X----E
                |
                S
    )",
                        20,
                        {"WXE>", "XS"});
    art.ways[0].turns = {{'X', 2, 0}};
    const auto roads = build_network(art.ways);
    EXPECT_FALSE(may_turn(roads, edge_between(art, 'W', 'X'), edge_between(art, 'X', 'S')));
}

TEST(SpeedLimit, IsTheSignpostedOneOrTheClass) {
    auto ways = road_art("A----B----C", 50, {"AB", "BC"}).ways;
    ways[0].highway = ways[1].highway = "residential";
    ways[1].speed_limit_cmps = 833; // 30 km/h
    const auto roads = build_network(ways);
    EXPECT_NEAR(speed_limit_mps(roads, LinkId{0}), 50 / 3.6, 0.005); // whole centimetres a second
    EXPECT_EQ(speed_limit_mps(roads, LinkId{1}), 8.33);
    EXPECT_EQ(way_at(roads, 0).speed_limit_cmps, 0); // what the map says, not what is usual
}

} // namespace
} // namespace macadam
