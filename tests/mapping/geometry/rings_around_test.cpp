#include "mapping/geometry/rings_around.hpp"

#include <gmock/gmock.h>

namespace macadam {
namespace {

using ::testing::ElementsAre;
using Ring = std::vector<RingPoint>;

TEST(RingsAround, TellsForEachPointTheRingThatHoldsIt) {
    const std::vector<Ring> rings{{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{6, 0}, {9, 0}, {6, 3}}};
    const std::vector<RingPoint> points{{8.5, 2}, {6.5, 1}, {1, 3}, {5, 1}, {1, -1}, {1, 9}};
    const auto found = rings_around(rings, points);
    ASSERT_TRUE(found);
    EXPECT_THAT(*found, ElementsAre(2, 1, 0, 2, 2, 2));
}

TEST(RingsAround, GivesUpWhereEverySideWouldBeComparedWithEveryPoint) {
    Ring comb;
    for (int i = 0; i < 1000; ++i) {
        comb.push_back({i * 1.0, i % 2 == 0 ? 0.0 : 1e6});
    }
    std::vector<RingPoint> points;
    for (int i = 0; i < 1000; ++i) {
        points.push_back({0.5, 1 + i * 1.0});
    }
    EXPECT_FALSE(rings_around(std::vector<Ring>{comb}, points, 900'000));
    EXPECT_TRUE(rings_around(std::vector<Ring>{comb}, points, 1'000'000));
}

} // namespace
} // namespace macadam
