// What positions, odometer, course and latency each tell of the way, and how sure it then is.

#include "mapping/matching/map_match.hpp"

#include "mapping/network/build_network.hpp"
#include "support/roads/match_art.hpp"
#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

using testing::ladder;
using testing::letters_of;
using testing::line_through;
using testing::match;
using testing::place_at;
using testing::road_art;
using testing::RoadArt;

TEST(MapMatch, TakesTheNearRoadOfTwoThatRunAlike) {
    const auto art = road_art(R"(
        A--------------------B
        C--------------------D
    )",
                              20,
                              {"AB", "CD"});
    const auto trip = testing::drive(line_through(art, "CD"), {.noise_m = 10});
    EXPECT_EQ(letters_of(match(trip, art), art), "CD");
}

/// From B to E over the bridge (straight on) or the long way round (C, D), unseen by the receiver.
struct TwoWays {
    RoadArt art = road_art(R"(
        A---------B---------E---------F

                  C---------D
    )",
                           20,
                           {"ABEF", "BCDE"});

    TripLog round_about() const {
        auto trip = testing::drive(line_through(art, "ABCDEF"), {.speeds = true});
        std::erase_if(trip.fixes, [](const GnssFix& fix) { return fix.t_s > 13 && fix.t_s < 41; });
        return trip;
    }
};

TEST(MapMatch, KnowsByTheOdometerWhichUnseenWayItTook) {
    const TwoWays there;
    const auto trace = match(there.round_about(), there.art);
    EXPECT_EQ(letters_of(trace, there.art), "ABCDEF");
}

TEST(MapMatch, FollowsTheOdometerBetterThanItsNoisyPositions) {
    const auto art = road_art(R"(
        A--------------------------------------------------B
    )",
                              40,
                              {"AB"}); // 2 km
    const auto line = line_through(art, "AB");
    const auto trace = match(testing::drive(line, {.noise_m = 5, .speeds = true}), art);
    double worst_m = 0;
    for (double travel_m = 50; travel_m < 1950; travel_m += 10) {
        const auto truth = between(line[0], line[1], travel_m / distance_m(line[0], line[1]));
        worst_m = std::max(worst_m, distance_m(place_at(trace, art, travel_m), truth));
    }
    EXPECT_LT(worst_m, 2.5); // single fixes err by 5 m, some by 15 m
}

TEST(MapMatch, IsSureOnALonelyRoad) {
    const auto art = road_art(R"(
        A--------------------B
    )",
                              20,
                              {"AB>"});
    const auto trace = match(testing::drive(line_through(art, "AB"), {.noise_m = 3}), art);
    ASSERT_FALSE(trace.empty());
    EXPECT_GT(trace.front().confidence, 0.95);
}

TEST(MapMatch, IsInTwoMindsHalfWayBetweenTwoRoads) {
    const auto art = road_art(R"(
        A--------------------B
        C--------------------D
    )",
                              15,
                              {"AB>", "CD>"});
    const auto a = art.places.at('A');
    const auto c = art.places.at('C');
    const auto b = art.places.at('B');
    const auto d = art.places.at('D');
    const auto trace = match(testing::drive({between(a, c, 0.49), between(b, d, 0.49)}), art);
    ASSERT_FALSE(trace.empty());
    EXPECT_GT(trace.front().confidence, 0.3);
    EXPECT_LT(trace.front().confidence, 0.8);
}

TEST(MapMatch, UsesTheCourseToTellACrossingRoad) {
    const auto art = road_art(R"(
                  N
                  |
        A---------B---------C
                  |
                  S
    )",
                              10,
                              {"ABC", "NBS"});
    // A short trip beside the crossing: only its course says along which road it went.
    const auto b = art.places.at('B');
    const GeoPoint from{b.lat_deg - 12 / 111150.0, b.lon_deg - 12 / 77830.0};
    const GeoPoint to{b.lat_deg + 12 / 111150.0, b.lon_deg - 12 / 77830.0};
    const auto trace = match(testing::drive({from, to}, {.speed_mps = 8, .courses = true}), art);
    ASSERT_FALSE(trace.empty());
    ASSERT_EQ(trace.front().kind, IntervalKind::road);
    EXPECT_EQ(way_at(art.roads, link_at(art.roads, trace.front().edge).way).name, "NBS");
}

TEST(MapMatch, TakesTheReceiversLatencyOff) {
    const auto art = ladder();
    auto trip = testing::drive(line_through(art, "ABC"), {.speeds = true});
    trip.meta.gnss_latency_s = 0.9;
    for (auto& fix : trip.fixes) {
        fix.t_s += 0.9;
    }
    const auto trace = match(trip, art);
    ASSERT_FALSE(trace.empty());
    EXPECT_NEAR(trace.front().t_enter_s, 0, 0.1);
}

TEST(MapMatch, OfAWorldWithoutRoadsIsOffTheNetwork) {
    const auto art = ladder();
    RoadArt nothing;
    nothing.roads = build_network({});
    const auto trace = match(testing::drive(line_through(art, "ABC")), nothing);
    ASSERT_EQ(trace.size(), 1u);
    EXPECT_EQ(trace[0].kind, IntervalKind::off_network);
}

TEST(MapMatch, IsTheSameEachTime) {
    const auto art = ladder();
    const auto trip = testing::drive(line_through(art, "ABEF"), {.noise_m = 8});
    const auto first = match(trip, art);
    const auto second = match(trip, art);
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(first[i].edge, second[i].edge);
        EXPECT_EQ(first[i].to_offset_m, second[i].to_offset_m);
    }
}

} // namespace
} // namespace macadam
