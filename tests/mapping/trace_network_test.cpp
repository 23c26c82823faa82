#include "mapping/trace_network.hpp"

#include "mapping/map_match.hpp"
#include "support/road_art.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace macadam {
namespace {

using ::testing::IsEmpty;
using testing::line_through;
using testing::road_art;
using testing::RoadArt;
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
    auto use = unused(trip);
    const auto odometer = make_odometer(trip, {}, use);
    const auto roads = build_network(traced({trip}));
    double on_road_m = 0;
    for (const auto& piece : map_match(trip, odometer, roads, {}, use)) {
        on_road_m += piece.kind == PieceKind::road ? piece.to_travel_m - piece.from_travel_m : 0;
    }
    EXPECT_GT(on_road_m / odometer.whole_m(), 0.97);
}

} // namespace
} // namespace macadam
