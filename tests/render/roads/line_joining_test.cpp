#include "render/roads/line_joining.hpp"

#include <gmock/gmock.h>

namespace macadam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

constexpr double step_deg = 0.001;

/// Through grid places, "A" (0, 0), each {east, north}.
MapLine line(std::vector<std::pair<int, int>> places) {
    MapLine made;
    for (const auto& [east, north] : places) {
        made.line.push_back({48 + north * step_deg, 16 + east * step_deg});
    }
    made.iri_class = 0;
    return made;
}

std::vector<std::vector<LineUse>> chains(const std::vector<MapLine>& lines) {
    return joined(lines, all_lines(lines));
}

} // namespace

TEST(LineJoining, FollowsPiecesEndToEndInAnyOrder) {
    const std::vector lines{line({{2, 0}, {3, 0}}), line({{0, 0}, {1, 0}}), line({{1, 0}, {2, 0}})};
    EXPECT_THAT(chains(lines), ElementsAre(ElementsAre(LineUse{1}, LineUse{2}, LineUse{0})));
}

TEST(LineJoining, GoesStraightOnWhereRoadsCross) {
    const std::vector lines{line({{0, 1}, {1, 1}}),
                            line({{1, 0}, {1, 1}}),
                            line({{1, 1}, {1, 2}}),
                            line({{1, 1}, {2, 1}})};
    EXPECT_THAT(chains(lines),
                UnorderedElementsAre(ElementsAre(LineUse{0}, LineUse{3}),
                                     ElementsAre(LineUse{1}, LineUse{2})));
}

TEST(LineJoining, NeverTurnsBackIntoTheOtherDirection) {
    EXPECT_THAT(chains({line({{0, 0}, {1, 0}}), line({{1, 0}, {0, 0}})}), ::testing::SizeIs(2));
}

TEST(LineJoining, KeepsRoadsOfDifferentRankApart) {
    std::vector lines{line({{0, 0}, {1, 0}}), line({{1, 0}, {2, 0}})};
    lines[1].rank = 3;
    EXPECT_THAT(chains(lines), ::testing::SizeIs(2));
}

TEST(LineJoining, ClosesARing) {
    const std::vector lines{line({{0, 0}, {1, 0}, {2, 1}}),
                            line({{2, 1}, {2, 2}, {1, 3}}),
                            line({{1, 3}, {0, 3}, {-1, 2}}),
                            line({{-1, 2}, {-1, 1}, {0, 0}})};
    EXPECT_THAT(chains(lines), ElementsAre(::testing::SizeIs(4)));
}

TEST(LineJoining, KeepsTheWorseOfTwoDirectionsAlongTheWay) {
    std::vector lines{line({{0, 0}, {1, 0}}), line({{1, 0}, {0, 0}})};
    lines[0].both_ways = lines[1].both_ways = true;
    lines[1].forward = false;
    lines[1].iri_class = 2;
    EXPECT_THAT(worse_of_both_ways(lines), ElementsAre(LineUse{1, true}));
}

TEST(LineJoining, KeepsTwoRoadsBetweenTheSamePlaces) {
    std::vector lines{line({{0, 0}, {1, 1}, {2, 0}}), line({{0, 0}, {1, -1}, {2, 0}})};
    lines[0].both_ways = lines[1].both_ways = true;
    EXPECT_THAT(worse_of_both_ways(lines), ::testing::SizeIs(2));
}

TEST(LineJoining, LeavesOutLinesWithoutADirection) {
    EXPECT_THAT(all_lines(std::vector{line({}), line({{0, 0}}), line({{1, 1}, {1, 1}})}),
                IsEmpty());
}

} // namespace macadam::testing
