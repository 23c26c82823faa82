#include "mapping/network/build_network.hpp"
#include "mapping/simulation/route.hpp"

#include "estimator/common/error.hpp"
#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

using namespace macadam;
using namespace macadam::testing;
using ::testing::HasSubstr;

namespace {

constexpr std::size_t trips = 40;
constexpr std::uint64_t seed = 7;

/// Two blocks of 400 m by 400 m, a oneway street across one, and a dead end.
RoadArt town() {
    return road_art(R"(
        A---B---C---X
        |   |   |
        D---E---F
    )",
                    100,
                    {"ABC", "DEF", "AD", "BE>", "CF", "CX"});
}

DrivingRecipe short_trips() {
    DrivingRecipe driving;
    driving.length_km = {2, 3};
    driving.places = 6;
    return driving;
}

std::vector<std::vector<EdgeId>> routes_in(const RoadNetwork& roads, const DrivingRecipe& driving) {
    const auto map = make_route_map(roads, driving, seed);
    std::vector<std::vector<EdgeId>> routes;
    for (std::size_t trip = 0; trip < trips; ++trip) {
        routes.push_back(route_of_trip(roads, map, driving, seed, trip));
    }
    return routes;
}

double length_of(const RoadNetwork& roads, const std::vector<EdgeId>& route) {
    double sum_m = 0;
    for (const auto edge : route) {
        sum_m += length_m(roads, edge);
    }
    return sum_m;
}

} // namespace

TEST(Route, GoesOnWhereItCameToByRoadsThatMayBeDriven) {
    const auto art = town();
    const auto routes = routes_in(art.roads, short_trips());
    ASSERT_FALSE(routes.empty());
    for (const auto& route : routes) {
        ASSERT_FALSE(route.empty());
        for (std::size_t i = 0; i < route.size(); ++i) {
            EXPECT_TRUE(is_drivable(art.roads, route[i]));
            if (i > 0) {
                EXPECT_EQ(from_node(art.roads, route[i]), to_node(art.roads, route[i - 1]));
            }
        }
    }
}

TEST(Route, TurnsBackOnlyWhereTheRoadEnds) {
    const auto art = town();
    std::size_t turns = 0;
    for (const auto& route : routes_in(art.roads, short_trips())) {
        for (std::size_t i = 1; i < route.size(); ++i) {
            if (route[i] == reversed(route[i - 1])) {
                EXPECT_EQ(out_edges(art.roads, from_node(art.roads, route[i])).size(), 1U);
                ++turns;
            }
        }
    }
    EXPECT_GT(turns, 0U); // else this test has seen nothing
}

TEST(Route, NeverTurnsWhereTheMapForbidsIt) {
    auto art = town();
    const auto turns_south_at_c = [&] {
        std::size_t count = 0;
        for (const auto& route : routes_in(art.roads, short_trips())) {
            for (std::size_t i = 1; i < route.size(); ++i) {
                count += route[i - 1] == edge_between(art, 'B', 'C') &&
                                 route[i] == edge_between(art, 'C', 'F')
                             ? 1
                             : 0;
            }
        }
        return count;
    };
    EXPECT_GT(turns_south_at_c(), 0U);
    constexpr std::int64_t south_way = 5; // "CF"
    art.ways.front().turns.push_back({.via_node = 'C', .to_way = south_way});
    art.roads = build_network(art.ways);
    EXPECT_EQ(turns_south_at_c(), 0U);
}

TEST(Route, IsAsLongAsDrawnGiveOrTakeItsLastEdge) {
    const auto art = town();
    auto driving = short_trips();
    driving.return_share = 0;
    const auto routes = routes_in(art.roads, driving);
    ASSERT_FALSE(routes.empty());
    for (const auto& route : routes) {
        const double length = length_of(art.roads, route);
        EXPECT_GE(length, 2000);
        EXPECT_LE(length, 3000 + length_m(art.roads, route.back()));
    }
}

TEST(Route, BackEndsWhereTheWayOutBegan) {
    const auto art = town();
    auto driving = short_trips();
    driving.return_share = 0.5;
    const auto routes = routes_in(art.roads, driving);
    for (std::size_t trip = 1; trip < trips; trip += 2) {
        ASSERT_TRUE(is_return(driving, seed, trip));
        EXPECT_EQ(from_node(art.roads, routes[trip].front()),
                  to_node(art.roads, routes[trip - 1].back()));
        EXPECT_EQ(to_node(art.roads, routes[trip].back()),
                  from_node(art.roads, routes[trip - 1].front()));
    }
}

TEST(Route, OfAFleetCoversBothDirections) {
    const auto art = town();
    std::set<EdgeId> driven;
    for (const auto& route : routes_in(art.roads, short_trips())) {
        driven.insert(route.begin(), route.end());
    }
    const auto both =
        std::ranges::count_if(driven, [&](EdgeId edge) { return driven.contains(reversed(edge)); });
    EXPECT_GE(both, 10); // of 12 edges of two-way roads
}

TEST(Route, IsAnotherForAnotherSeed) {
    const auto art = town();
    const auto driving = short_trips();
    const auto map = make_route_map(art.roads, driving, 1);
    EXPECT_NE(route_of_trip(art.roads, map, driving, 1, 0),
              route_of_trip(art.roads, map, driving, 2, 0));
}

TEST(Route, KeepsPlacesToWhereOneComesBackFrom) {
    const auto art = road_art(R"(
        A---B---C---X
        |   |
        D---E
    )",
                              100,
                              {"AB", "BE", "ED", "DA", "BC>", "CX>"});
    const auto map = make_route_map(art.roads, short_trips(), seed);
    EXPECT_EQ(map.places.size(), 4U); // A, B, D, E: C and X lead nowhere
}

TEST(Route, NeedsAWayBack) {
    const auto art = road_art("A---B---C", 100, {"AB>", "BC>"});
    try {
        make_route_map(art.roads, short_trips(), seed);
        FAIL() << "a street that leads away only was taken";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("expected a network with round trips"));
    }
}

TEST(Route, KnowsRoadsThatFlow) {
    EXPECT_TRUE(flows_freely("trunk_link"));
    EXPECT_FALSE(flows_freely("primary"));
}
