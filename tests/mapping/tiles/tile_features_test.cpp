#include "mapping/tiles/tile_features.hpp"

#include <gtest/gtest.h>

namespace macadam {
namespace {

TEST(WorldPoint, LiesInTheTileThatTheGridNames) {
    const GeoPoint place{35.6590699, 139.7006793};
    const auto point = world_point(place);
    for (int zoom = 0; zoom <= 20; ++zoom) {
        const auto expected = tile_position(place, zoom);
        EXPECT_EQ(
            tile_at(point, zoom),
            (TileId{std::uint8_t(zoom), std::uint32_t(expected.x), std::uint32_t(expected.y)}));
    }
}

TEST(WorldPoint, StaysInTheWorldAtItsCorners) {
    EXPECT_EQ(world_point({89, -180}), (WorldPoint{0, 0}));
    EXPECT_EQ(world_point({-89, 180}), (WorldPoint{0xffffffff, 0xffffffff}));
    EXPECT_EQ(tile_at({0xffffffff, 0xffffffff}, 0), (TileId{0, 0, 0}));
}

TEST(TileSegment, BelongsToTheSameTileInBothDirections) {
    TileSegment there{}, back{};
    there.line = {{7, 100}, {40, 30}, {10, 11}};
    back.line = {there.line.rbegin(), there.line.rend()};
    EXPECT_EQ(middle_of(there), middle_of(back));
}

TEST(TileWords, AreNumberedOnce) {
    TileWords words;
    EXPECT_EQ(words.number_of(""), 0U);
    const auto lane = words.number_of("Lane");
    for (int i = 0; i < 1000; ++i) {
        words.number_of("Road " + std::to_string(i));
    }
    EXPECT_EQ(words.number_of("Lane"), lane);
    EXPECT_EQ(words.word(lane), "Lane");
    EXPECT_NE(words.number_of("Road 7"), words.number_of("Road 8"));
}

} // namespace
} // namespace macadam
