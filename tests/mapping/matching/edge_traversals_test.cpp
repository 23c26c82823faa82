#include "mapping/matching/edge_traversals.hpp"

#include "support/roads/match_art.hpp"
#include "support/roads/sensed_car.hpp"

#include <gmock/gmock.h>

namespace macadam {
namespace {

using ::testing::SizeIs;

constexpr EdgeId first{0};
constexpr EdgeId second{2};

/// On an edge at 10 m/s; travel runs with the time.
MatchedInterval
on(EdgeId edge, double from_m, double to_m, double travel_m, double confidence = 0.9) {
    const double end_m = travel_m + to_m - from_m;
    return {IntervalKind::road,
            edge,
            travel_m,
            end_m,
            from_m,
            to_m,
            travel_m / 10,
            end_m / 10,
            confidence,
            ""};
}

MatchedInterval hole(double from_m, double to_m, const std::string& reason) {
    return {IntervalKind::gap, EdgeId{}, from_m, to_m, 0, 0, from_m / 10, to_m / 10, 0, reason};
}

TEST(EdgeTraversals, AreOneForAnEdgeHoweverFinelyItWasMatched) {
    const auto traversals = edge_traversals({on(first, 20, 50, 0),
                                             on(first, 50, 60, 30),
                                             on(first, 60, 100, 40),
                                             on(second, 0, 30, 80)});
    ASSERT_THAT(traversals, SizeIs(2));
    EXPECT_EQ(traversals[0].from_offset_m, 20);
    EXPECT_EQ(traversals[0].to_offset_m, 100);
    EXPECT_EQ(traversals[0].to_travel_m, 80);
    EXPECT_EQ(traversals[0].t_leave_s, 8);
    EXPECT_EQ(traversals[1].edge, second);
}

TEST(EdgeTraversals, AreAsSureAsTheirPiecesByLength) {
    const auto traversals = edge_traversals({on(first, 0, 30, 0, 0.5), on(first, 30, 40, 30, 0.9)});
    ASSERT_THAT(traversals, SizeIs(1));
    EXPECT_NEAR(traversals[0].confidence, (30 * 0.5 + 10 * 0.9) / 40, 1e-12);
}

TEST(EdgeTraversals, AreAsUnsureOfTheirPlaceAsTheirWorstPiece) {
    std::vector pieces{on(first, 0, 30, 0), on(first, 30, 40, 30), on(first, 40, 60, 40)};
    pieces[0].offset_sd_m = 1.2;
    pieces[1].offset_sd_m = 3.4;
    pieces[2].offset_sd_m = 0.7;
    const auto traversals = edge_traversals(pieces);
    ASSERT_THAT(traversals, SizeIs(1));
    EXPECT_EQ(traversals[0].offset_sd_m, 3.4);
}

TEST(EdgeTraversals, AreTwoForAnEdgeThatIsDrivenTwiceInARow) {
    EXPECT_THAT(edge_traversals({on(first, 0, 100, 0), on(first, 0, 100, 100)}), SizeIs(2));
}

TEST(EdgeTraversals, AreTwoForAUTurnWithinAnEdge) {
    EXPECT_THAT(edge_traversals({on(first, 0, 60, 0), on(reversed(first), 40, 100, 60)}),
                SizeIs(2));
}

TEST(EdgeTraversals, KeepAHoleBetweenTwoPartsOfAnEdge) {
    const auto traversals =
        edge_traversals({on(first, 0, 40, 0), hole(40, 60, "why"), on(first, 40, 80, 60)});
    EXPECT_THAT(traversals, SizeIs(3));
}

TEST(EdgeTraversals, JoinHolesOfOneReasonOnly) {
    EXPECT_THAT(edge_traversals({hole(0, 10, "a"), hole(10, 20, "a"), hole(20, 30, "b")}),
                SizeIs(2));
}

TEST(EdgeTraversals, SwallowSpecksAndLeaveNoHoleInTheTime) {
    auto standing = on(second, 5, 5.001, 100);
    standing.t_leave_s = 70;
    auto after = on(first, 0, 10, 100.001);
    after.t_enter_s = 70;
    const auto traversals = edge_traversals({on(first, 0, 100, 0), standing, after});
    ASSERT_THAT(traversals, SizeIs(2));
    EXPECT_EQ(traversals[0].t_leave_s, 70);
    EXPECT_EQ(traversals[0].to_travel_m, traversals[1].from_travel_m);
}

TEST(EdgeTraversals, SwallowASpeckAtTheBeginning) {
    const auto traversals = edge_traversals({on(second, 99.99, 100, 0), on(first, 0, 100, 0.01)});
    ASSERT_THAT(traversals, SizeIs(1));
    EXPECT_EQ(traversals[0].from_travel_m, 0);
    EXPECT_EQ(traversals[0].t_enter_s, 0);
}

TEST(EdgeTraversals, SwallowAHoleOfNoLength) {
    const auto traversals = edge_traversals({on(first, 0, 100, 0), hole(100, 100.02, "why")});
    ASSERT_THAT(traversals, SizeIs(1));
    EXPECT_EQ(traversals[0].to_travel_m, 100.02);
}

TEST(EdgeTraversals, OfADriveOverFourEdgesAreFour) {
    const auto art = testing::road_art(R"(
        A---------B---------C---------D---------E
    )",
                                       20,
                                       {"AB", "BC", "CD", "DE"});
    const auto trip =
        testing::sensed(testing::line_through(art, "ABCDE"), testing::Sensors::odometer);
    EXPECT_THAT(edge_traversals(testing::match(trip, art)), SizeIs(4));
}

TEST(EdgeTraversals, OfNothingAreNothing) {
    EXPECT_THAT(edge_traversals({}), SizeIs(0));
}

} // namespace
} // namespace macadam
