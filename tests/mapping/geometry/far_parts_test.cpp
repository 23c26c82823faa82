#include "mapping/geometry/far_parts.hpp"

#include <gmock/gmock.h>

namespace macadam {
namespace {

using ::testing::SizeIs;

constexpr GeoBox all{.west_deg = 10, .south_deg = 48, .east_deg = 11.5, .north_deg = 49};

/// Adds a grid of positions.
void add_town(FarParts& data, const GeoPoint& corner, double side_deg, double weight) {
    for (int i = 0; i < 100; ++i) {
        data.add(
            {corner.lat_deg + side_deg * (i / 10) / 9, corner.lon_deg + side_deg * (i % 10) / 9},
            weight);
    }
}

TEST(FarParts, AreTownsFarFromEachOtherTheOneWithTheMostRoadsFirst) {
    FarParts data{all};
    add_town(data, {48, 10}, 0.05, 1);
    add_town(data, {48.9, 11.4}, 0.1, 2);
    const auto parts = data.parts();
    ASSERT_THAT(parts, SizeIs(2));
    EXPECT_NEAR(parts[0].weight, 200, 1e-9);
    EXPECT_NEAR(parts[0].box.south_deg, 48.9, 1e-9);
    EXPECT_NEAR(parts[0].box.east_deg, 11.5, 1e-9);
    EXPECT_NEAR(parts[1].box.north_deg, 48.05, 1e-9);
}

TEST(FarParts, AreOneIfTheyLieCloserThanATenthOfTheWhole) {
    FarParts data{all};
    add_town(data, {48, 10}, 0.5, 1);
    add_town(data, {48, 10.6}, 0.5, 1); // 7 km of 110 km apart
    add_town(data, {48.5, 10.5}, 0.5, 1);
    EXPECT_THAT(data.parts(), SizeIs(1));
}

TEST(FarParts, AreNoneWithoutPositionsAndOneOfASinglePosition) {
    EXPECT_THAT(FarParts{all}.parts(), SizeIs(0));
    FarParts one{{.west_deg = 10, .south_deg = 48, .east_deg = 10, .north_deg = 48}};
    one.add({48, 10}, 1);
    EXPECT_THAT(one.parts(), SizeIs(1));
}

} // namespace
} // namespace macadam
