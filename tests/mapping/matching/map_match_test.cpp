#include "mapping/matching/map_match.hpp"

#include "support/roads/match_art.hpp"
#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

using ::testing::HasSubstr;
using testing::ladder;
using testing::letters_of;
using testing::line_through;
using testing::match;
using testing::road_art;
using testing::RoadArt;

TEST(MapMatch, StaysOnTheRoadItCameFrom) {
    const auto art = ladder(); // the other road is 40 m away
    const auto trip = testing::drive(line_through(art, "ABC"), {.noise_m = 8, .speeds = true});
    EXPECT_EQ(letters_of(match(trip, art), art), "ABC");
}

TEST(MapMatch, FollowsATurn) {
    const auto art = road_art(R"(
        A---------B---------C
                  |
                  |
                  |
        D---------E---------F
    )",
                              20,
                              {"ABC", "DEF", "BE"});
    const auto trip = testing::drive(line_through(art, "ABED"), {.noise_m = 5});
    EXPECT_EQ(letters_of(match(trip, art), art), "ABED");
}

TEST(MapMatch, KnowsTheDirectionOfTravel) {
    const auto art = ladder();
    EXPECT_EQ(letters_of(match(testing::drive(line_through(art, "CBA")), art), art), "CBA");
}

TEST(MapMatch, ReadsTheDirectionOfAShortTripFromTheOrderOfItsPositions) {
    const auto art = ladder();
    EXPECT_EQ(letters_of(match(testing::drive(line_through(art, "C2B")), art), art), "CB");
}

TEST(MapMatch, DoesNotDriveAgainstAOneway) {
    const auto art = road_art(R"(
        A---------B
        C---------D
    )",
                              20,
                              {"AB>", "DC>"}); // a dual carriageway, 40 m wide
    const auto trip = testing::drive(line_through(art, "BA"), {.noise_m = 3});
    EXPECT_EQ(letters_of(match(trip, art), art), "DC");
}

TEST(MapMatch, GoesRoundARoundabout) {
    const auto art = road_art(R"(
                  N
                  |
                  B
        W------A     C------E
                  D
                  |
                  S
    )",
                              8,
                              {"ADCBA>", "WA", "CE", "BN", "DS"});
    const auto trip = testing::drive(line_through(art, "WADCBN"), {.speed_mps = 7, .noise_m = 2});
    EXPECT_EQ(letters_of(match(trip, art), art), "WADCBN");
}

TEST(MapMatch, TurnsRoundAtADeadEnd) {
    const auto art = road_art(R"(
        A-------------------B
    )",
                              20,
                              {"AB"});
    const auto trip = testing::drive(line_through(art, "ABA"), {.noise_m = 3, .speeds = true});
    EXPECT_EQ(letters_of(match(trip, art), art), "ABA");
}

TEST(MapMatch, FindsWhereItTurnedWithinAnEdge) {
    const auto art = road_art(R"(
        A-----------------------------------------------------------B
    )",
                              20,
                              {"AB"});
    auto line = line_through(art, "A5B"); // 600 m ahead of A, then 300 m on and back
    line.back() = between(line.front(), line.back(), 0.5);
    line.push_back(line.front());
    const auto trace = match(testing::drive(line, {.noise_m = 3, .speeds = true}), art);
    double farthest_m = 0;
    for (const auto& piece : trace) {
        if (piece.edge == testing::edge_between(art, 'A', 'B')) {
            farthest_m = std::max(farthest_m, piece.to_offset_m);
        }
    }
    const double turned_m = distance_m(art.places.at('A'), line[1]);
    EXPECT_NEAR(farthest_m, turned_m, 10); // a sample comes each 40 m, noise 3 m
    EXPECT_EQ(trace.back().edge, testing::edge_between(art, 'B', 'A'));
}

TEST(MapMatch, BridgesATunnelByTheRoad) {
    const auto art = road_art(R"(
        A----B
             |                                      G----H
             C--------------------------------------F
    )",
                              40,
                              {"AB", "BC", "CF", "FG", "GH"});
    auto trip = testing::drive(line_through(art, "ABCFGH"), {.noise_m = 3, .speeds = true});
    const auto silent = [](const GnssFix& fix) { return fix.t_s > 25 && fix.t_s < 120; };
    trip.fixes.erase(std::remove_if(trip.fixes.begin(), trip.fixes.end(), silent),
                     trip.fixes.end());
    EXPECT_EQ(letters_of(match(trip, art), art), "ABCFGH");
}

/// A road with a car park 240 m off it.
struct WithCarPark {
    RoadArt art = road_art(R"(
        A---------B---------C---------D



                  P---------Q
    )",
                           30,
                           {"ABCD"});
    TripLog trip = testing::drive(line_through(art, "ABPQCD"), {.noise_m = 3});
};

TEST(MapMatch, LeavesTheNetworkWhereTheMapHasNoRoad) {
    const WithCarPark there;
    double off_m = 0;
    for (const auto& piece : match(there.trip, there.art)) {
        off_m +=
            piece.kind == IntervalKind::off_network ? piece.to_travel_m - piece.from_travel_m : 0;
    }
    EXPECT_NEAR(off_m, 240 + 300 + 240, 2 * 80); // 60 m at each end still count as on the road
}

TEST(MapMatch, SaysWhyItLeftTheNetwork) {
    const WithCarPark there;
    const auto trace = match(there.trip, there.art);
    const auto off = std::find_if(trace.begin(), trace.end(), [](const auto& piece) {
        return piece.kind == IntervalKind::off_network;
    });
    ASSERT_NE(off, trace.end());
    EXPECT_THAT(off->reason, HasSubstr("no fitting road within 60 m"));
    EXPECT_EQ(off->confidence, 0);
}

TEST(MapMatch, CutsTheTraceWhereNoWayJoinsTwoRoads) {
    const auto art = road_art(R"(
        A---------B     C---------D
    )",
                              20,
                              {"AB", "CD"});
    EXPECT_EQ(letters_of(match(testing::drive(line_through(art, "ABCD")), art), art), "AB-CD");
}

TEST(MapMatch, IsContiguousInTravel) {
    const WithCarPark there;
    const auto trace = match(there.trip, there.art);
    ASSERT_GT(trace.size(), 1U);
    for (std::size_t i = 1; i < trace.size(); ++i) {
        EXPECT_DOUBLE_EQ(trace[i].from_travel_m, trace[i - 1].to_travel_m);
        EXPECT_LE(trace[i].from_travel_m, trace[i].to_travel_m);
        EXPECT_LE(trace[i].from_offset_m, trace[i].to_offset_m);
    }
}

TEST(MapMatch, BeginsAndEndsWithinEdges) {
    const auto art = ladder();
    const auto trip = testing::drive(line_through(art, "A5BC"), {.speeds = true});
    const auto trace = match(trip, art);
    ASSERT_FALSE(trace.empty());
    EXPECT_NEAR(trace.front().from_offset_m, 100, 1); // half of AB, no noise
    EXPECT_NEAR(trace.back().to_offset_m, 200, 14);   // the last fix is up to a second earlier
}

TEST(MapMatch, SurvivesOneBadPoint) {
    const auto art = ladder();
    auto trip = testing::drive(line_through(art, "ABC"), {.noise_m = 3});
    trip.fixes[12].at.lat_deg += 0.0018; // 200 m to the north
    EXPECT_EQ(letters_of(match(trip, art), art), "ABC");
}

TEST(MapMatch, SurvivesABadFirstFix) {
    const auto art = ladder();
    auto trip = testing::drive(line_through(art, "ABC"), {.noise_m = 3});
    trip.fixes[0].at.lat_deg += 0.02;
    EXPECT_EQ(letters_of(match(trip, art), art), "ABC");
}

TEST(MapMatch, ReturnsToItsRoadAfterAPausedRecording) {
    const auto art = road_art("A---------B", 300, {"AB"});
    auto trip = testing::drive(line_through(art, "AB"), {.noise_m = 2, .courses = true});
    constexpr std::size_t paused = 60;
    constexpr std::size_t missing = 20; // fixes, 280 m, for which the clock stood still
    constexpr double step_s = 0.4;      // over the pause
    ASSERT_GT(trip.fixes.size(), 150U);
    const auto first = trip.fixes.begin() + paused;
    trip.fixes.erase(first, first + missing);
    for (auto i = paused; i < trip.fixes.size(); ++i) {
        trip.fixes[i].t_s -= missing + 1 - step_s;
    }
    for (auto& fix : trip.fixes) {
        fix.accuracy_m = 5;
    }
    trip.fixes[paused].accuracy_m = 65; // a receiver that begins anew
    trip.fixes[paused + 1].accuracy_m = 65;
    double off_road_m = 0;
    for (const auto& piece : match(trip, art)) {
        off_road_m +=
            piece.kind == IntervalKind::road ? 0 : piece.to_travel_m - piece.from_travel_m;
    }
    EXPECT_LT(off_road_m, 280 + 2 * 60); // the pause, and a sample or two at each side
}

TEST(MapMatch, TellsWhichFixesServed) {
    const auto art = ladder();
    auto trip = testing::drive(line_through(art, "ABC"));
    trip.fixes[5].at.lat_deg += 0.02;        // 2 km aside
    trip.fixes[7].at.lat_deg = std::nan(""); // nothing
    trip.fixes[9] = trip.fixes[8];           // once more
    trip.fixes[9].t_s += 0.5;
    trip.fixes[11].accuracy_m = 400;
    const Odometer odometer{{{0, 40}, {0, 400}, {10, 10}, {0, 0}}};
    const auto fixes = map_match(trip, odometer, art.roads, {}).fixes;
    ASSERT_EQ(fixes.size(), trip.fixes.size());
    EXPECT_EQ(fixes[4], 0);
    EXPECT_EQ(fixes[5], code(RowReason::implausible));
    EXPECT_EQ(fixes[7], code(RowReason::no_sample));
    EXPECT_EQ(fixes[9], code(RowReason::repeated_fix));
    EXPECT_EQ(fixes[11], code(RowReason::inaccurate));
}

TEST(MapMatch, CountsAStandstillAsNoWay) {
    const auto art = ladder();
    auto trip = testing::drive(line_through(art, "ABC"), {.noise_m = 4, .speeds = true});
    auto stood = trip;
    for (auto& fix : stood.fixes) {
        fix.t_s += fix.t_s > 10 ? 300 : 0;
    }
    for (auto& t_s : stood.speed.t_s) {
        t_s += t_s > 10 ? 300 : 0;
    }
    const auto at = std::upper_bound(stood.speed.t_s.begin(), stood.speed.t_s.end(), 10.0);
    const auto index = at - stood.speed.t_s.begin();
    for (int k = 0; k < 299; ++k) { // standing: 0 m/s each second, and positions that wander
        stood.speed.t_s.insert(stood.speed.t_s.begin() + index + k, 10.5 + k);
        stood.speed.speed_mps.insert(stood.speed.speed_mps.begin() + index + k, 0);
        auto fix = trip.fixes[10];
        fix.t_s = 10.6 + k;
        fix.at.lat_deg += 1e-4 * std::sin(k);
        stood.fixes.insert(stood.fixes.begin() + 11 + k, fix);
    }
    EXPECT_EQ(letters_of(match(stood, art), art), "ABC");
}

} // namespace
} // namespace macadam
