#include "mapping/tiles/tile_grid.hpp"

#include <gtest/gtest.h>

namespace macadam {
namespace {

// The example of OpenStreetMap's wiki, "Slippy map tilenames": Hachiko's statue in Tokyo.
TEST(TileGrid, NamesTheTileThatOpenStreetMapNames) {
    const auto place = tile_position({35.6590699, 139.7006793}, 18);
    EXPECT_EQ(int(place.x), 232798);
    EXPECT_EQ(int(place.y), 103246);
}

TEST(TileGrid, HasTheWholeMapInTheTileOfZoomZero) {
    const auto box = tile_box({0, 0, 0});
    EXPECT_NEAR(box.west_deg, -180, 1e-12);
    EXPECT_NEAR(box.east_deg, 180, 1e-12);
    EXPECT_NEAR(box.north_deg, 85.0511287798066, 1e-12); // EPSG:3857's area of use
    EXPECT_NEAR(box.south_deg, -85.0511287798066, 1e-12);
}

TEST(TileGrid, ComesBackToThePlaceItTook) {
    const GeoPoint point{-33.8568, 151.2153};
    const auto back = geo_point(tile_position(point, 22), 22);
    EXPECT_NEAR(back.lat_deg, point.lat_deg, 1e-10);
    EXPECT_NEAR(back.lon_deg, point.lon_deg, 1e-10);
}

TEST(TileGrid, FindsEveryTileThatABoxTouchesAndNoOther) {
    const auto inner = tile_box({10, 550, 340});
    const auto one = tiles_of({inner.west_deg + 1e-9,
                               inner.south_deg + 1e-9,
                               inner.east_deg - 1e-9,
                               inner.north_deg - 1e-9},
                              10);
    EXPECT_EQ(one.first_x, 550U);
    EXPECT_EQ(one.last_x, 550U);
    EXPECT_EQ(one.first_y, 340U);
    EXPECT_EQ(one.last_y, 340U);

    const auto wide = tiles_of(tile_box({10, 550, 340}, 0.5), 10);
    EXPECT_EQ(wide.first_x, 549U);
    EXPECT_EQ(wide.last_x, 551U);
    EXPECT_EQ(wide.first_y, 339U);
    EXPECT_EQ(wide.last_y, 341U);
}

TEST(TileGrid, StaysOnTheMapAtThePolesAndTheAntimeridian) {
    const auto all = tiles_of({-180, -90, 180, 90}, 3);
    EXPECT_EQ(all.first_x, 0U);
    EXPECT_EQ(all.last_x, 7U);
    EXPECT_EQ(all.first_y, 0U);
    EXPECT_EQ(all.last_y, 7U);
}

} // namespace
} // namespace macadam
