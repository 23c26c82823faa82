#include "estimator/motion/make_odometer.hpp"
#include "mapping/matching/lattice/error_model.hpp"
#include "mapping/matching/lattice/lattice.hpp"

#include "support/roads/match_art.hpp"
#include "support/roads/road_art.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace macadam {
namespace {

using testing::drive;
using testing::letters_of;
using testing::line_through;
using testing::match;
using testing::road_art;
using testing::RoadArt;

constexpr double m_per_deg = 111'195; // of a meridian

GeoPoint moved(const GeoPoint& place, double north_m) {
    return {place.lat_deg + north_m / m_per_deg, place.lon_deg};
}

std::vector<GeoPoint> moved(std::vector<GeoPoint> line, double north_m) {
    for (auto& place : line) {
        place = moved(place, north_m);
    }
    return line;
}

TEST(MatchExcursions, EndOnAShortRoadBetweenTwoThatTheMapLacks) {
    const auto art = road_art(R"(
        A---------B     C------D     E---------F
    )",
                              15,
                              {"AB", "CD", "EF"}); // CD is 105 m, the holes 90 m
    const auto trace = match(drive(line_through(art, "ABCDEF"), {.noise_m = 1}), art);
    EXPECT_EQ(letters_of(trace, art), "AB-CD-EF");
}

TEST(MatchExcursions, DoNotLeadToTheRoadBeside) {
    const auto art = road_art(R"(
        A---------------------------------------B
        C---------------------------------------D
    )",
                              8, // 16 m between them, 320 m long
                              {"AB>", "CD>"});
    const auto line = line_through(art, "AB");
    const auto half = between(line[0], line[1], 0.5);
    // From the middle on the positions lie on the road beside: no car can have gone over.
    const std::vector<GeoPoint> slid{
        line[0], half, moved(between(half, line[1], 0.1), -14), moved(line[1], -14)};
    EXPECT_EQ(letters_of(match(drive(slid, {.noise_m = 1}), art), art), "AB");
}

TEST(MatchExcursions, AreNotWhatACoarselyDrawnBendMakes) {
    const auto art = road_art(R"(
        A--------------------B--------------------C
                             P
    )",
                              20,
                              {"ABC"}); // the car went by P, 40 m off the line
    EXPECT_EQ(letters_of(match(drive(line_through(art, "AB")), art), art), "AB");
    const auto trace = match(drive(line_through(art, "APC"), {.noise_m = 2}), art);
    EXPECT_TRUE(std::all_of(trace.begin(), trace.end(), [](const MatchedInterval& piece) {
        return piece.kind == IntervalKind::road;
    }));
}

/// What is learnt of a drive on a two-way road, so many metres left of its line.
RoadSpread spread_of_drive(double left_m) {
    const auto art = road_art(R"(
        A-------------------------------------------------B
    )",
                              20,
                              {"AB"});
    const auto trip = drive(moved(line_through(art, "AB"), left_m), {.noise_m = 1});
    const auto odometer = make_odometer(trip, {}).odometer;
    const Heading no_gyro;
    const MatchConfig config;
    const auto positions = positions_of(trip, odometer, no_gyro, config);
    CandidateIndex plane{art.roads, positions.frame};
    return road_spread(positions, art.roads, plane, config);
}

TEST(MatchExcursions, KnowOnWhichSideTheTripDrives) {
    // The road goes east. The median of 35 samples of 1 m is good to 0.2 m; a fifth is doubt.
    EXPECT_NEAR(spread_of_drive(-4).two_way_lane_m, 4 * 35 / 43.0, 0.5);
    EXPECT_NEAR(spread_of_drive(4).two_way_lane_m, -4 * 35 / 43.0, 0.5);
    EXPECT_EQ(spread_of_drive(4).oneway_lane_m, 0); // there is none
}

TEST(MatchExcursions, CountASlideToTheSideOnlyOnce) {
    constexpr double sd_m = 3;
    SamplePair between{};
    between.kept = 0.9;
    Candidate here{};
    Candidate there{};
    here.right_m = 15;
    there.right_m = 15;
    const double stays = lateral_jump_cost(here, there, between, sd_m);
    here.right_m = 0;
    const double slides = lateral_jump_cost(here, there, between, sd_m);
    EXPECT_GT(slides, 10 * stays);
    EXPECT_LT(slides, 1.2); // 0.3 of the bound
    between.standing = true;
    EXPECT_EQ(lateral_jump_cost(here, there, between, sd_m), 0);
    between.standing = false;
    there.course_rad =
        std::numbers::pi_v<float> / 2; // round a corner the one says nothing of the other
    here.right_m = 15;
    const double round_a_corner = lateral_jump_cost(here, there, between, sd_m);
    here.right_m = 0;
    EXPECT_NEAR(round_a_corner, lateral_jump_cost(here, there, between, sd_m), 1e-6); // floats
}

/// Two oneway roads with one direction, 14 m apart: the fixes of a receiver whose errors are small
/// lie on the northern one.
TEST(MatchExcursions, SeeARoadThatTheMapLacksBesideOneThatItHas) {
    const auto art = road_art(R"(
        A----------B--------------------C----------D
                   E--------------------F
    )",
                              15,
                              {"AB>", "CD>", "BE>", "EF>", "FC>"}); // BC is missing, EF 30 m south
    const auto trace = match(drive(line_through(art, "ABCD"), {.noise_m = 1}), art);
    EXPECT_EQ(letters_of(trace, art), "AB-CD");
}

} // namespace
} // namespace macadam
