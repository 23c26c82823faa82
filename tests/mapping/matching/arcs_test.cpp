#include "mapping/matching/arcs.hpp"
#include "mapping/matching/map_match.hpp"
#include "support/roads/road_art.hpp"

#include <gmock/gmock.h>

namespace macadam {
namespace {

using testing::edge_between;
using testing::road_art;
using testing::RoadArt;

MatchedInterval on(EdgeId edge, double from_offset_m, double to_offset_m) {
    return {IntervalKind::road, edge, 0, 1, from_offset_m, to_offset_m, 10, 20, 1, ""};
}

std::string text_of(const MatchedTrace& trace, const RoadArt& art) {
    std::string text;
    for (const auto& arc : arcs_of(trace, art.roads)) {
        text += {static_cast<char>(arc.from_node), static_cast<char>(arc.to_node), ' '};
    }
    return text;
}

/// 200 m between letters; B and C are bends of one edge.
RoadArt bends() {
    return road_art(R"(
        A---------B---------C---------D
    )",
                    20,
                    {"ABCD"});
}

TEST(ArcsOf, GivesFirstAndLastWhole) {
    const auto art = bends();
    EXPECT_EQ(text_of({on(edge_between(art, 'A', 'B'), 150, 450)}, art), "AB BC CD ");
}

TEST(ArcsOf, LeavesOutWhatWasNotDriven) {
    const auto art = bends();
    EXPECT_EQ(text_of({on(edge_between(art, 'A', 'B'), 250, 350)}, art), "BC ");
}

TEST(ArcsOf, LeavesOutWhatNoiseAloneTouched) {
    const auto art = bends();
    EXPECT_EQ(text_of({on(edge_between(art, 'A', 'B'), 197, 404)}, art), "BC ");
    EXPECT_EQ(text_of({on(edge_between(art, 'A', 'B'), 194, 406)}, art), "AB BC CD ");
}

TEST(ArcsOf, AddsUpThePiecesOfAnArc) {
    const auto art = bends();
    const auto edge = edge_between(art, 'A', 'B');
    EXPECT_EQ(text_of({on(edge, 193, 197), on(edge, 197, 200), on(edge, 200, 300)}, art), "AB BC ");
}

TEST(ArcsOf, RunsBackwardOnABackwardEdge) {
    const auto art = bends();
    EXPECT_EQ(text_of({on(edge_between(art, 'B', 'A'), 50, 350)}, art), "DC CB ");
}

TEST(ArcsOf, DoesNotRepeatAnArcInWhichTwoPiecesMeet) {
    const auto art = bends();
    const auto edge = edge_between(art, 'A', 'B');
    EXPECT_EQ(text_of({on(edge, 150, 300), on(edge, 300, 450)}, art), "AB BC CD ");
}

TEST(ArcsOf, RepeatsAnArcThatIsDrivenAgain) {
    const auto art = bends();
    const auto edge = edge_between(art, 'A', 'B');
    EXPECT_EQ(text_of({on(edge, 150, 300), on(edge, 10, 100)}, art), "AB BC AB ");
}

TEST(ArcsOf, ComesBackAfterAUTurnWithinAnEdge) {
    const auto art = bends();
    const auto edge = edge_between(art, 'A', 'B');
    EXPECT_EQ(text_of({on(edge, 0, 300), on(reversed(edge), 300, 600)}, art), "AB BC CB BA ");
}

TEST(ArcsOf, TellsWhenEachWasEntered) {
    const auto art = bends();
    const auto arcs = arcs_of({on(edge_between(art, 'A', 'B'), 100, 300)}, art.roads);
    ASSERT_EQ(arcs.size(), 2u);
    EXPECT_EQ(arcs[0].t_enter_s, 10);         // the trip began within it
    EXPECT_NEAR(arcs[1].t_enter_s, 15, 0.05); // B is half-way; the art's degrees are rounded
}

TEST(ArcsOf, SkipsHoles) {
    const auto art = bends();
    auto hole = on(edge_between(art, 'A', 'B'), 0, 500);
    hole.kind = IntervalKind::off_network;
    EXPECT_EQ(text_of({hole}, art), "");
}

} // namespace
} // namespace macadam
