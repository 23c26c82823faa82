#include "estimator/motion/make_odometer.hpp"
#include "mapping/inference/network_inference.hpp"

#include "mapping/matching/map_match.hpp"
#include "mapping/network/build_network.hpp"
#include "support/roads/road_art.hpp"
#include "support/roads/sensed_car.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace macadam {
namespace {

using ::testing::IsEmpty;
using testing::line_through;
using testing::road_art;
using testing::RoadArt;
using testing::sensed;
using testing::Sensors;
using ::testing::SizeIs;

/// 400 m between letters of a row, 240 m between rows.
RoadArt block() {
    return road_art(R"(
        A----------B----------C



        D----------E----------F
    )",
                    36,
                    {"ABC", "DEF", "BE", "CF"});
}

std::vector<Way> traced(const std::vector<TripLog>& trips) {
    return trace_network(trips, {});
}

double length_of(const std::vector<GeoPoint>& line) {
    double sum_m = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        sum_m += distance_m(line[i - 1], line[i]);
    }
    return sum_m;
}

TEST(TraceNetwork, DrawsOneOnewayRoadForOneTrip) {
    const auto art = block();
    const auto ways = traced({testing::drive(line_through(art, "ABC"), {.noise_m = 2})});
    ASSERT_THAT(ways, SizeIs(1));
    EXPECT_EQ(ways[0].oneway, Oneway::forward);
    EXPECT_EQ(ways[0].id, 1);
    EXPECT_LT(distance_m(ways[0].line.front(), art.places.at('A')), 10);
}

TEST(TraceNetwork, TakesTheNoiseOutOfTheLine) {
    const auto art = block();
    const auto line = line_through(art, "ABC");
    const auto ways = traced({testing::drive(line, {.noise_m = 3})});
    ASSERT_THAT(ways, SizeIs(1));
    // 3 m of noise each 14 m would make the way 4 % longer if every position were believed.
    EXPECT_NEAR(length_of(ways[0].line) / length_of(line), 1, 0.015);
}

TEST(TraceNetwork, DoesNotDrawTheSameRoadTwice) {
    const auto art = block();
    const auto line = line_through(art, "ABC");
    EXPECT_THAT(traced({testing::drive(line, {.noise_m = 2, .seed = 1}),
                        testing::drive(line, {.noise_m = 2, .seed = 2})}),
                SizeIs(1));
}

TEST(TraceNetwork, DrawsTheOtherDirectionAsItsOwnRoad) {
    const auto art = block();
    EXPECT_THAT(traced({testing::drive(line_through(art, "ABC")),
                        testing::drive(line_through(art, "CBA"))}),
                SizeIs(2));
}

TEST(TraceNetwork, BranchesWhereASecondTripTurnsOff) {
    const auto art = block();
    const auto ways = traced({testing::drive(line_through(art, "ABC"), {.noise_m = 1}),
                              testing::drive(line_through(art, "ABE"), {.noise_m = 1, .seed = 2})});
    ASSERT_THAT(ways, SizeIs(2));
    EXPECT_THAT(ways[0].node_ids, ::testing::Contains(ways[1].node_ids.front()));
    EXPECT_LT(distance_m(ways[1].line.front(), art.places.at('B')), 30);
}

TEST(TraceNetwork, DrawsALapOnceHoweverOftenItIsDriven) {
    const auto art = block();
    const auto once = line_through(art, "BCFEB");
    auto thrice = once;
    for (int lap = 0; lap < 2; ++lap) {
        thrice.insert(thrice.end(), once.begin() + 1, once.end());
    }
    const auto ways = traced({testing::drive(thrice, {.noise_m = 1})});
    const double drawn_m =
        std::accumulate(ways.begin(), ways.end(), 0.0, [](double sum, const Way& way) {
            return sum + length_of(way.line);
        });
    EXPECT_NEAR(
        drawn_m / length_of(once), 1, 0.1); // where a lap joins the first it overlaps a little
}

TEST(TraceNetwork, DrawsNothingThroughASilence) {
    const auto art = block();
    auto trip = testing::drive(line_through(art, "ABC"));
    std::erase_if(trip.fixes, [](const GnssFix& fix) { return fix.t_s > 20 && fix.t_s < 40; });
    EXPECT_THAT(traced({trip}), SizeIs(2));
}

TEST(TraceNetwork, DrawsNoRoadThroughAJump) {
    const auto art = block();
    auto trip = testing::drive(line_through(art, "ABC"), {});
    const auto before_m = length_of(traced({trip}).front().line);
    // A part of the positions lies 200 m to the north, for longer than single faults do.
    const auto third = trip.fixes.size() / 3;
    for (std::size_t i = third; i < 2 * third; ++i) {
        trip.fixes[i].at.lat_deg += 200 / 111195.0;
    }
    double drawn_m = 0;
    for (const auto& way : traced({trip})) {
        drawn_m += length_of(way.line);
    }
    EXPECT_LT(drawn_m, before_m); // two ways across would add 400 m
}

std::vector<std::vector<GeoPoint>> lines_of(const std::vector<Way>& ways) {
    std::vector<std::vector<GeoPoint>> lines;
    for (const auto& way : ways) {
        lines.push_back(way.line);
    }
    return lines;
}

/// The same fixes on the other side of the globe.
void move_to_antipodes(std::span<GnssFix> fixes) {
    for (auto& fix : fixes) {
        fix.at = {-fix.at.lat_deg, fix.at.lon_deg - 179};
    }
}

TEST(TraceNetwork, DrawsRoadsOfTwoContinentsAsIfEachWereAlone) {
    const auto art = block();
    const auto here = testing::drive(line_through(art, "ABC"), {.noise_m = 2});
    auto there = testing::drive(line_through(art, "ABEF"), {.noise_m = 2, .seed = 2});
    move_to_antipodes(there.fixes);
    auto alone = lines_of(traced({here}));
    const auto others = lines_of(traced({there}));
    ASSERT_FALSE(alone.empty());
    ASSERT_FALSE(others.empty());
    alone.insert(alone.end(), others.begin(), others.end());
    const auto both = traced({here, there});
    EXPECT_THAT(lines_of(both), ::testing::UnorderedElementsAreArray(alone));
    for (std::size_t i = 0; i < both.size(); ++i) {
        EXPECT_EQ(both[i].id, static_cast<std::int64_t>(i + 1));
    }
    EXPECT_NE(both.front().node_ids.front(), both.back().node_ids.front());
}

TEST(TraceNetwork, DrawsNoRoadThroughAFlightAndKeepsItsSpacing) {
    const auto art = block();
    auto trip = testing::drive(line_through(art, "ABC"), {.noise_m = 1});
    const double before_m = length_of(traced({trip}).front().line);
    move_to_antipodes(std::span{trip.fixes}.subspan(trip.fixes.size() / 2));
    const auto ways = traced({trip});
    ASSERT_THAT(ways, SizeIs(2));
    double drawn_m = 0;
    for (const auto& way : ways) {
        drawn_m += length_of(way.line);
        for (std::size_t i = 1; i < way.line.size(); ++i) {
            EXPECT_NEAR(distance_m(way.line[i - 1], way.line[i]), 10, 2);
        }
    }
    EXPECT_NEAR(drawn_m, before_m, 40); // without the step of the flight
}

/// A fix each 9.9 s.
TripLog sparse_trip(std::size_t fixes, double step_m) {
    TripLog trip;
    for (std::size_t i = 0; i < fixes; ++i) {
        const auto step = static_cast<double>(i);
        trip.fixes.push_back({9.9 * step, {47 + step * step_m / 111'200, 8}, NAN, NAN, NAN});
    }
    return trip;
}

TEST(TraceNetwork, DrawsAtMostFortyPointsForAFix) {
    constexpr std::size_t fixes = 100;
    const auto ways = traced({sparse_trip(fixes, 395)});
    ASSERT_THAT(ways, SizeIs(1));
    EXPECT_GT(ways[0].line.size(), 35 * fixes);
    EXPECT_LE(ways[0].line.size(), 40 * fixes);
}

TEST(TraceNetwork, BridgesNoStepOfOverFourHundredMetres) {
    EXPECT_THAT(traced({sparse_trip(100, 405)}), IsEmpty());
}

TEST(TraceNetwork, DoesNotBelieveAReceiverThatDoesNotBelieveItself) {
    const auto art = block();
    auto trip = testing::drive(line_through(art, "ABC"));
    trip.fixes.front().at.lat_deg += 0.003;
    trip.fixes.front().accuracy_m = 65;
    const auto ways = traced({trip});
    ASSERT_THAT(ways, SizeIs(1));
    EXPECT_LT(distance_m(ways[0].line.front(), art.places.at('A')), 20);
}

TEST(TraceNetwork, OfNoTripsIsEmpty) {
    EXPECT_THAT(traced({}), IsEmpty());
}

TEST(TraceNetwork, OfATripThatStoodIsEmpty) {
    TripLog trip;
    for (int k = 0; k < 100; ++k) {
        trip.fixes.push_back({1.0 * k, {47 + 1e-6 * (k % 3), 8}, NAN, NAN, NAN});
    }
    EXPECT_THAT(traced({trip}), IsEmpty());
}

TEST(TraceNetwork, CarriesTheTripThatDrewIt) {
    const auto art = block();
    auto line = line_through(art, "ABEF");
    const auto trip = testing::drive(line, {.noise_m = 2, .speeds = true});
    const auto odometer = make_odometer(trip, {}).odometer;
    const auto roads = build_network(traced({trip}));
    double on_road_m = 0;
    for (const auto& piece : map_match(trip, odometer, roads, {}).trace) {
        on_road_m += piece.kind == IntervalKind::road ? piece.to_travel_m - piece.from_travel_m : 0;
    }
    EXPECT_GT(on_road_m / odometer.whole_m(), 0.97);
}

/// Of several trips over one line, with errors of their own.
std::vector<TripLog> drives(const std::vector<GeoPoint>& line, int count, double noise_m) {
    std::vector<TripLog> trips;
    for (int i = 0; i < count; ++i) {
        trips.push_back(sensed(line,
                               Sensors::positions,
                               {.noise_m = noise_m, .seed = static_cast<std::uint64_t>(i + 1)}));
    }
    return trips;
}

double drawn_m(const std::vector<Way>& ways) {
    return std::accumulate(ways.begin(), ways.end(), 0.0, [](double sum, const Way& way) {
        return sum + length_of(way.line);
    });
}

std::size_t holes_in(const TripLog& trip, const std::vector<Way>& ways) {
    const auto trace =
        map_match(trip, make_odometer(trip, {}).odometer, build_network(ways), {}).trace;
    return static_cast<std::size_t>(std::count_if(
        trace.begin(), trace.end(), [](const auto& p) { return p.kind != IntervalKind::road; }));
}

TEST(TraceNetwork, IsTheSameInAnyOrderOfTheTrips) {
    const auto art = block();
    std::vector<TripLog> trips;
    for (const auto* const letters : {"ABC", "ABEF", "CBA", "DEBC", "FEB"}) {
        trips.push_back(sensed(line_through(art, letters), Sensors::positions));
    }
    const auto first = traced(trips);
    std::swap(trips[0], trips[4]);
    std::swap(trips[1], trips[3]);
    const auto second = traced(trips);
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(first[i].node_ids, second[i].node_ids);
        EXPECT_EQ(first[i].line, second[i].line);
    }
}

TEST(TraceNetwork, CountsATripThatOccursTwiceOnce) {
    const auto art = block();
    auto trips = drives(line_through(art, "ABC"), 2, 4);
    trips[0].sha256 = "a";
    trips[1].sha256 = "b";
    const auto once = traced(trips);
    const auto again = trips[0];
    trips.insert(trips.end(), {again, again, again});
    EXPECT_EQ(traced(trips).front().line, once.front().line);
}

TEST(TraceNetwork, DrawsTheMiddleOfItsTrips) {
    const auto art = block();
    const auto line = line_through(art, "ABC");
    const auto ways = traced(drives(line, 16, 4));
    ASSERT_THAT(ways, SizeIs(1));
    double squares = 0;
    for (const auto& point : ways[0].line) {
        const double north_m =
            (point.lat_deg - line[0].lat_deg) * 111150 + 2; // the lane: 2 m south
        squares += north_m * north_m;
    }
    // 4 m over the root of 16, and the trimmed mean 7 % more; 800 m are about two independent
    // errors.
    EXPECT_LT(std::sqrt(squares / static_cast<double>(ways[0].line.size())), 2);
}

TEST(TraceNetwork, DrawsARoadOnceHoweverBadThePositionsAre) {
    const auto art = block();
    const auto ways = traced(drives(line_through(art, "ABC"), 12, 8));
    EXPECT_NEAR(drawn_m(ways) / 800, 1, 0.1); // ends differ by some 10 m from trip to trip
}

TEST(TraceNetwork, LeavesOutATripThatStrayed) {
    const auto art = block();
    const auto line = line_through(art, "ABC");
    auto trips = drives(line, 6, 2);
    for (auto& fix : trips.back().fixes) {
        fix.at.lat_deg += fix.t_s > 20 && fix.t_s < 40 ? 25 / 111150.0 : 0;
    }
    EXPECT_THAT(traced(trips), SizeIs(1));
}

TEST(TraceNetwork, JoinsRoadsThatCrossWhereATripTurned) {
    const auto art = road_art(R"(
                    N
                    |
                    |
        A-----------B-----------C
                    |
                    |
                    S
    )",
                              20,
                              {"ABC", "NBS"});
    const auto across = [&](const char* letters) {
        return sensed(line_through(art, letters), Sensors::odometer, {.noise_m = 1});
    };
    const auto crossing = traced({across("ABC"), across("NBS")});
    const auto joined = traced({across("ABC"), across("NBS"), across("ABS")});
    EXPECT_GT(holes_in(across("ABS"), crossing), 0U); // one may be a bridge
    EXPECT_EQ(holes_in(across("ABS"), joined), 0U);
    EXPECT_EQ(holes_in(across("ABC"), joined), 0U);
    EXPECT_EQ(holes_in(across("NBS"), joined), 0U);
}

TEST(TraceNetwork, JoinsAWayToItselfWhereATripTurned) {
    const auto art = block(); // the first trip crosses its own way at B
    const auto loop = sensed(line_through(art, "ABCFEB"), Sensors::odometer, {.noise_m = 1});
    auto on = line_through(art, "EB");
    on.push_back(between(on[0], on[1], 1.5));
    auto whole = line_through(art, "ABCFEB");
    whole.push_back(on.back());
    const auto crossing = sensed(whole, Sensors::odometer, {.noise_m = 1});
    const auto turning = sensed(line_through(art, "FEBC"), Sensors::odometer, {.noise_m = 1});
    EXPECT_EQ(holes_in(turning, traced({crossing, loop, turning})), 0U);
}

TEST(TraceNetwork, DrawsNoRoadWhereACarTurnedRound) {
    const auto art = block();
    auto line = line_through(art, "AB");
    line.push_back(between(line[0], line[1], 0.5));
    line.push_back(line[1]);
    line.push_back(art.places.at('C'));
    // From A to B, half of the way back, and on to C: 400 m each way to C, 200 m back.
    const auto ways = traced({sensed(line, Sensors::positions, {.noise_m = 1})});
    EXPECT_NEAR(drawn_m(ways), 800 + 200, 60);
}

TEST(TraceNetwork, JoinsBothDirectionsAtADeadEnd) {
    const auto art = block();
    const auto trip = sensed(line_through(art, "ABCBA"), Sensors::odometer, {.noise_m = 1});
    const auto ways = traced({trip});
    ASSERT_THAT(ways, SizeIs(2));
    EXPECT_EQ(ways[0].node_ids.back(), ways[1].node_ids.front());
    EXPECT_EQ(holes_in(trip, ways), 0U);
}

TEST(TraceNetwork, DrawsNothingOfAStandstill) {
    const auto art = block();
    const auto line = line_through(art, "ABC");
    for (const auto sensors : {Sensors::positions, Sensors::odometer}) {
        const auto trip = sensed(line, sensors, {.noise_m = 6, .stops = {{300, 600}}});
        EXPECT_NEAR(drawn_m(traced({trip})), 800, 60) << name_of(sensors);
    }
}

} // namespace
} // namespace macadam
