// The places where map matchers err, each drawn once and driven with each set of sensors that
// ought to suffice.

#include "mapping/matching/map_match.hpp"

#include "support/roads/match_art.hpp"
#include "support/roads/road_art.hpp"
#include "support/roads/sensed_car.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

using testing::all_sensor_sets;
using testing::CarConfig;
using testing::letters_of;
using testing::line_through;
using testing::match;
using testing::name_of;
using testing::road_art;
using testing::RoadArt;
using testing::sensed;
using testing::Sensors;

constexpr Sensors with_odometer[] = {Sensors::odometer, Sensors::gyro};

double kind_m(const MatchedTrace& trace, IntervalKind kind) {
    double sum_m = 0;
    for (const auto& piece : trace) {
        sum_m += piece.kind == kind ? piece.to_travel_m - piece.from_travel_m : 0;
    }
    return sum_m;
}

/// Along edges, whatever the travel was.
double driven_on_roads_m(const MatchedTrace& trace) {
    double sum_m = 0;
    for (const auto& piece : trace) {
        sum_m += piece.to_offset_m - piece.from_offset_m;
    }
    return sum_m;
}

double length_m(const std::vector<GeoPoint>& line) {
    double sum_m = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        sum_m += distance_m(line[i - 1], line[i]);
    }
    return sum_m;
}

/// Drives through the letters, again with other errors, and expects to be matched to them.
void expect_driven(const RoadArt& art,
                   std::string_view letters,
                   std::span<const Sensors> sets,
                   const CarConfig& config = {}) {
    for (const auto sensors : sets) {
        for (std::uint64_t seed = 1; seed <= 5; ++seed) {
            SCOPED_TRACE(name_of(sensors) + ", seed " + std::to_string(seed));
            auto car = config;
            car.seed = seed;
            const auto trip = sensed(line_through(art, letters), sensors, car);
            std::string expected{letters};
            std::erase_if(expected, [](char c) { return c >= '0' && c <= '9'; });
            EXPECT_EQ(letters_of(match(trip, art), art), expected);
        }
    }
}

/// Two streets 30 m apart that begin and end together.
TEST(NamedCases, OfTwoParallelRoadsTheNearOne) {
    const auto art = road_art(R"(
                 B-------------------------------------------------C
        A-------P                                                   S-------D
                 E-------------------------------------------------F
    )",
                              7.5,
                              {"APBCSD", "PEFS"});
    expect_driven(art, "APBCSD", all_sensor_sets);
    expect_driven(art, "APEFSD", all_sensor_sets);
}

/// A dual carriageway whose lines lie 10 m apart. The positions are 7 m to the left of the one that
/// is driven, so that they lie nearer to the other.
TEST(NamedCases, OnTheCarriagewayOfItsDirectionThoughTheOtherIsNearer) {
    const auto art = road_art(R"(
        D-----------------------------------------------------------------------C
        A-----------------------------------------------------------------------B
    )",
                              5,
                              {"AB>", "CD>"});
    expect_driven(art, "AB", all_sensor_sets, {.lane_m = -7});
    expect_driven(art, "CD", all_sensor_sets, {.lane_m = -7});
}

TEST(NamedCases, UnderABridgeStraightOn) {
    const auto art = road_art(R"(
                            N
                            |
                            |
                            |
        A---------------------------------------B
                            |
                            |
                            |
                            S
    )",
                              10,
                              {"AB", "NS"});
    expect_driven(art, "AB", all_sensor_sets);
    expect_driven(art, "NS", all_sensor_sets);
}

/// An elevated road that maps draw 8 m beside the street under it, for 200 m. Positions cannot tell
/// them apart there; the ways that lead on can.
TEST(NamedCases, OnStackedRoadsTheOneThatLeadsOn) {
    const auto art = road_art(R"(
                                                                                           K




                     C--------------------------------------------------F
        A----------B---P--------------------------------------------------Q-----------------------H
    )",
                              4,
                              {"ABPQH", "BCFK"});
    expect_driven(art, "ABPQH", all_sensor_sets);
    expect_driven(art, "ABCFK", all_sensor_sets);
}

/// The slip road runs 15 m beside the motorway for 220 m before it turns away.
TEST(NamedCases, OffASlipRoadOrOnStraightOn) {
    const auto art = road_art(R"(
        A---------------B-------------------------------------------------C-----------------D
                           S-----------------------------T
                                                                U


                                                                     V
    )",
                              7.5,
                              {"ABCD>", "BSTUV>"});
    expect_driven(art, "ABCD", all_sensor_sets, {.cruise_mps = 25});
    expect_driven(art, "ABSTUV", all_sensor_sets, {.cruise_mps = 20});
}

RoadArt roundabout() {
    return road_art(R"(
                           N
                           |
                           |
                           |
                         B
        W---------------A     C--------------E
                           D
                           |
                           |
                           |
                           S
    )",
                    8,
                    {"ADCBA>", "WA", "CE", "BN", "DS"});
}

TEST(NamedCases, RoundARoundaboutToTheThirdExit) {
    expect_driven(roundabout(), "WADCBN", all_sensor_sets, {.cruise_mps = 8});
}

TEST(NamedCases, RoundARoundaboutAndBack) {
    expect_driven(roundabout(), "WADCBAW", all_sensor_sets, {.cruise_mps = 8});
}

TEST(NamedCases, AUTurnWithinAnEdge) {
    const auto art = road_art(R"(
        A------------------------------------------------------------B
    )",
                              20,
                              {"AB"});
    auto line = line_through(art, "AB");
    line[1] = between(line[0], line[1], 0.5);
    line.push_back(line[0]);
    for (const auto sensors : all_sensor_sets) {
        SCOPED_TRACE(name_of(sensors));
        const auto trace = match(sensed(line, sensors), art);
        double farthest_m = 0;
        for (const auto& piece : trace) {
            farthest_m = std::max(farthest_m, is_forward(piece.edge) ? piece.to_offset_m : 0);
        }
        EXPECT_EQ(letters_of(trace, art), "ABA");
        EXPECT_NEAR(farthest_m, length_m(line) / 2, 15); // errors of 3 m, one sample each 40 m
        EXPECT_NEAR(driven_on_roads_m(trace), length_m(line), 2 * 15 + 14); // last fix: 1 s early
    }
}

TEST(NamedCases, OnTheRoadToTheVeryLastPosition) {
    const auto art = road_art(R"(
        A-------------------B-------------------C
                            |
                            S
    )",
                              20,
                              {"ABC", "BS"});
    for (const auto sensors : all_sensor_sets) {
        for (std::uint64_t seed = 1; seed <= 5; ++seed) {
            SCOPED_TRACE(name_of(sensors) + ", seed " + std::to_string(seed));
            CarConfig car;
            car.seed = seed;
            const auto trace = match(sensed(line_through(art, "A3B5C"), sensors, car), art);
            EXPECT_EQ(kind_m(trace, IntervalKind::gap), 0);
            EXPECT_EQ(kind_m(trace, IntervalKind::off_network), 0);
        }
    }
}

TEST(NamedCases, IntoADeadEndAndBack) {
    const auto art = road_art(R"(
        A---------------------B-----------------------C
                              |
                              |
                              |
                              |
                              D
    )",
                              10,
                              {"ABC", "BD"});
    expect_driven(art, "ABDBC", all_sensor_sets);
}

/// A car park 200 m beside the road: round it, ten minutes of standing, and back the same way.
TEST(NamedCases, IntoACarParkThatTheMapDoesNotKnow) {
    const auto art = road_art(R"(
        A-------------------------B-------------------------C




                                  P------Q
                                  R------S
    )",
                              20,
                              {"ABC"});
    const auto line = line_through(art, "ABPQSRPBC");
    const double parked_m = length_m(line_through(art, "ABPQS"));
    const double outside_m = length_m(line_through(art, "BPQSRPB"));
    for (const auto sensors : all_sensor_sets) {
        SCOPED_TRACE(name_of(sensors));
        const auto trace = match(sensed(line, sensors, {.stops = {{parked_m, 600}}}), art);
        EXPECT_THAT(letters_of(trace, art), ::testing::MatchesRegex("AB.*-.*BC")); // one hole
        EXPECT_NEAR(kind_m(trace, IntervalKind::road), length_m(line_through(art, "ABC")), 150);
        if (sensors != Sensors::positions) { // wandering positions lengthen the way
            EXPECT_NEAR(kind_m(trace, IntervalKind::off_network), outside_m, 150);
        }
    }
}

/// 1.4 km of water between two landings. The car stands on the ferry.
TEST(NamedCases, OverTheWaterOnAFerry) {
    const auto art = road_art(R"(
        A---------B                                                            C---------D
    )",
                              20,
                              {"AB", "CD"});
    for (const auto sensors : all_sensor_sets) {
        SCOPED_TRACE(name_of(sensors));
        auto trip = sensed(line_through(art, "ABCD"), sensors, {.cruise_mps = 7});
        const double on_s = 200 / 7.0;
        const double off_s = on_s + 1300 / 7.0;
        for (std::size_t k = 0; k < trip.speed.t_s.size(); ++k) {
            const bool aboard = trip.speed.t_s[k] > on_s && trip.speed.t_s[k] < off_s;
            trip.speed.speed_mps[k] = aboard ? 0 : trip.speed.speed_mps[k];
        }
        EXPECT_EQ(letters_of(match(trip, art), art), "AB-CD");
    }
}

/// 3.6 km without positions; a road over the hill is 0.8 km longer, one beside the tunnel's mouth
/// ends.
TEST(NamedCases, ThroughALongTunnel) {
    const auto art = road_art(R"(
                          M-------------------------------N


        A---------B                                               C---------D
                         K-------L
    )",
                              75,
                              {"ABCD", "BMNC", "BKL"});
    const double mouth_m = length_m(line_through(art, "AB"));
    const double end_m = length_m(line_through(art, "ABC"));
    CarConfig car{.cruise_mps = 22, .silences = {{mouth_m + 10, end_m - 10}}};
    expect_driven(art, "ABCD", all_sensor_sets, car);
}

TEST(NamedCases, OverTheHillWhereThePositionsAreSilentButTheWheelsAreNot) {
    const auto art = road_art(R"(
                          M-------------------------------N


        A---------B                                               C---------D
    )",
                              75,
                              {"ABCD", "BMNC"});
    const double mouth_m = length_m(line_through(art, "AB"));
    const double end_m = length_m(line_through(art, "ABMNC"));
    CarConfig car{.cruise_mps = 22, .silences = {{mouth_m + 10, end_m - 10}}};
    expect_driven(art, "ABMNCD", with_odometer, car);
}

TEST(NamedCases, TwiceRoundALoop) {
    const auto art = road_art(R"(
        A----------B----------C
                   |          |
                   |          |
                   |          |
                   E----------F
    )",
                              20,
                              {"ABC", "CFEB"});
    expect_driven(art, "ABCFEBCFEBA", all_sensor_sets);
}

/// Ten minutes at the lights with positions that wander by 8 m.
TEST(NamedCases, StandingAtTheLightsIsNoWay) {
    const auto art = road_art(R"(
                              N
                              |
                              |
                              |
        A---------------------B-----------------------C
                              |
                              |
                              |
                              S
    )",
                              10,
                              {"ABC", "NBS"});
    const auto line = line_through(art, "ABC");
    const double lights_m = length_m(line_through(art, "AB")) - 8;
    CarConfig car{.noise_m = 8, .stops = {{lights_m, 600}}};
    expect_driven(art, "ABC", all_sensor_sets, car);
    for (const auto sensors : all_sensor_sets) {
        SCOPED_TRACE(name_of(sensors));
        EXPECT_NEAR(driven_on_roads_m(match(sensed(line, sensors, car), art)),
                    length_m(line),
                    4 * 8); // either end errs by twice the positions' sd at most
    }
}

/// The carriageways of a dual road, one of them drawn against its traffic.
TEST(NamedCases, OnAOnewayDrawnAgainstItsTraffic) {
    const auto art = road_art(R"(
        A--------------------------------------B
        C--------------------------------------D
    )",
                              10,
                              {"AB<", "CD>"});
    expect_driven(art, "BA", all_sensor_sets);
    expect_driven(art, "CD", all_sensor_sets);
    const auto trace = match(sensed(line_through(art, "BA"), Sensors::positions), art);
    ASSERT_FALSE(trace.empty());
    EXPECT_FALSE(is_forward(trace.front().edge));
}

/// For a minute the receiver stands 2 km to the north, on another road; then it comes back.
TEST(NamedCases, AMinuteOfPositionsTwoKilometresAside) {
    const auto art = road_art(R"(
        E-----------------------------------------------------------F







        A-----------------------------------------------------------B
    )",
                              125,
                              {"AB", "EF"});
    for (const auto sensors : all_sensor_sets) {
        SCOPED_TRACE(name_of(sensors));
        auto trip = sensed(line_through(art, "AB"), sensors, {.cruise_mps = 25});
        for (auto& fix : trip.fixes) {
            fix.at.lat_deg += fix.t_s >= 100 && fix.t_s < 160 ? 2000 / 111150.0 : 0;
        }
        const auto trace = match(trip, art);
        for (const auto& piece : trace) {
            const bool well = piece.t_leave_s < 95 || piece.t_enter_s > 165;
            if (piece.kind == IntervalKind::road && well) {
                EXPECT_EQ(piece.edge, testing::edge_between(art, 'A', 'B'));
            }
        }
        EXPECT_GT(kind_m(trace, IntervalKind::road), 0.75 * 7500); // a fifth is lost at most
        EXPECT_LT(driven_on_roads_m(trace), 1.02 * 7500);          // and nothing made up
    }
}

/// The recording stops and goes on 2 km farther, on a road that nothing joins.
TEST(NamedCases, AJumpOfTwoKilometresIsAHole) {
    const auto art = road_art(R"(
        A---------B                                        C---------D
    )",
                              40,
                              {"AB", "CD"});
    for (const auto sensors : all_sensor_sets) {
        SCOPED_TRACE(name_of(sensors));
        auto trip = sensed(line_through(art, "AB"), sensors);
        const double later_s = trip.fixes.back().t_s + 1;
        auto after = sensed(line_through(art, "CD"), sensors, {.seed = 2});
        for (auto fix : after.fixes) {
            fix.t_s += later_s;
            trip.fixes.push_back(fix);
        }
        for (std::size_t k = 0; k < after.speed.t_s.size(); ++k) {
            trip.speed.t_s.push_back(after.speed.t_s[k] + later_s);
            trip.speed.speed_mps.push_back(after.speed.speed_mps[k]);
        }
        trip.gyro = {};
        EXPECT_EQ(letters_of(match(trip, art), art), "AB-CD");
    }
}

} // namespace
} // namespace macadam
