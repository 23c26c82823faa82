#include "mapping/matching/lattice/edge_routing.hpp"
#include "mapping/matching/lattice/lattice.hpp"

#include "mapping/network/build_network.hpp"
#include "support/roads/match_art.hpp"
#include "support/roads/road_art.hpp"
#include "support/roads/town.hpp"

#include <gtest/gtest.h>

#include <random>

namespace macadam {
namespace {

using testing::drive;
using testing::letters_of;
using testing::line_through;
using testing::made_up_town;
using testing::match;
using testing::road_art;

constexpr double u_turn_m = 200;

/// The first edge of a way, along it.
EdgeId first_edge_of(const RoadNetwork& roads, std::uint32_t number) {
    return edge_of(LinkId{way_at(roads, number - 1).first_link}, true);
}

TEST(MatchRoutes, AreAsShortTowardsATargetAsThoseOfASearchOfEverything) {
    const auto roads = made_up_town(40); // 4.4 km wide
    EdgeRouter routes{roads, u_turn_m};
    std::mt19937 random{3};
    const auto edges = drivable_edges(roads);
    std::uniform_int_distribution<std::size_t> any{0, edges.size() - 1};
    std::size_t looked_at = 0, whole = 0, found = 0;
    for (int i = 0; i < 200; ++i) {
        const auto from = edges[any(random)];
        const auto target = edges[any(random)];
        const double longest_m = 3000;
        const auto all = routes.towards(from, {}, longest_m);
        const auto towards = routes.towards(from, std::span{&target, 1}, longest_m);
        const auto* expected = find(all, target);
        const auto* way = find(towards, target);
        ASSERT_EQ(way == nullptr, expected == nullptr);
        if (way != nullptr) {
            // float sums over some 30 edges
            EXPECT_NEAR(way->way_m + way->turn_m, expected->way_m + expected->turn_m, 0.01);
            ++found;
        }
        looked_at += towards.size();
        whole += all.size();
    }
    EXPECT_GT(found, 50U);
    EXPECT_LT(looked_at, whole / 4); // an ellipse of the circle, and ended at the target
}

TEST(MatchRoutes, TakeAsLongAsTheLimitsAllow) {
    auto art = road_art("A---------B---------C---------D", 10, {"AB", "BC", "CD"});
    art.ways[1].speed_limit_cmps = 1000; // 10 m/s over the 100 m from B to C
    const auto roads = build_network(art.ways);
    EdgeRouter routes{roads, u_turn_m};
    const auto from = first_edge_of(roads, 1);
    const auto to = first_edge_of(roads, 3);
    const auto* way = find(routes.towards(from, std::span{&to, 1}, 1000), to);
    ASSERT_NE(way, nullptr);
    EXPECT_NEAR(way->way_m, 100, 0.1);
    EXPECT_NEAR(way->min_s, 10, 0.01);
}

TEST(MatchRoutes, OfAFastCarLeadOverTheFastRoadOfTwoThatLieBesideEachOther) {
    auto art = road_art(R"(
        A---------------------------------------------------------------B
        C---------------------------------------------------------------D
    )",
                        10, // 20 m between them, 650 m long
                        {"AB>", "CD>"});
    art.ways[0].speed_limit_cmps = 3600;
    art.ways[1].speed_limit_cmps = 830; // 30 km/h
    art.roads = build_network(art.ways);
    auto line = line_through(art, "AB");
    for (auto& place : line) {
        place.lat_deg -= 0.00010; // 11 m from the fast road, 9 from the slow
    }
    EXPECT_EQ(letters_of(match(drive(line, {.speed_mps = 33, .noise_m = 1}), art), art), "AB");
    EXPECT_EQ(letters_of(match(drive(line, {.speed_mps = 8, .noise_m = 1}), art), art), "CD");
}

} // namespace
} // namespace macadam
