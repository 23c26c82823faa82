#include "app/render/data_parts.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace macadam::testing {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr GeoBox country{.west_deg = 16, .south_deg = 48, .east_deg = 16.1, .north_deg = 48.4};
constexpr DetailRoom room{
    .count = 3, .scale_denominator = 10'000, .width_m = 2000, .height_m = 1500};

/// A town: lengths all over a square of 600 m.
void add_town(std::vector<MeasuredLength>& measured, const GeoPoint& middle, double km) {
    constexpr int side = 5;
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            measured.push_back(
                {{middle.lat_deg + 0.0012 * (row - 2), middle.lon_deg + 0.0018 * (column - 2)},
                 1000 * km / (side * side)});
        }
    }
}

TEST(MapDetails, ShowTheTownsWithMostMeasuredRoadFromNorthToSouth) {
    std::vector<MeasuredLength> measured;
    const GeoPoint south{48.1, 16.05};
    const GeoPoint north{48.3, 16.03};
    add_town(measured, south, 12);
    add_town(measured, north, 20);
    add_town(measured, {48.2, 16.07}, 2); // not worth a map
    const auto areas = densest_areas(measured, country, room);
    ASSERT_THAT(areas, SizeIs(2));
    EXPECT_TRUE(contains(areas[0], north));
    EXPECT_TRUE(contains(areas[1], south));
    const double middle_deg = (areas[0].south_deg + areas[0].north_deg) / 2;
    EXPECT_NEAR(middle_deg, north.lat_deg, 0.001); // the town in its middle
    EXPECT_NEAR(distance_m({middle_deg, areas[0].west_deg}, {middle_deg, areas[0].east_deg}),
                room.width_m,
                10); // the longitude's length changes over the box
}

TEST(MapDetails, FollowALongRoadInItsOrder) {
    std::vector<MeasuredLength> measured;
    for (double lat_deg = 48.01; lat_deg < 48.39; lat_deg += 0.0002) {
        measured.push_back({{lat_deg, 16.05}, 20});
    }
    const auto areas = densest_areas(measured, country, room);
    ASSERT_THAT(areas, SizeIs(3));
    EXPECT_GT(areas[0].south_deg, areas[1].south_deg);
    EXPECT_GT(areas[1].south_deg, areas[2].south_deg);
}

TEST(MapDetails, ShowNothingTwiceThoughEachIsCentred) {
    std::vector<MeasuredLength> measured;
    for (const double lon_deg : {16.030, 16.048}) { // half a sheet apart: both at its edges
        add_town(measured, {48.2, lon_deg}, 12);
    }
    add_town(measured, {48.2, 16.064}, 10);
    const auto areas = densest_areas(measured, country, room);
    ASSERT_GE(areas.size(), 2U);
    for (std::size_t i = 0; i + 1 < areas.size(); ++i) {
        const auto& a = areas[i];
        const auto& b = areas[i + 1];
        EXPECT_TRUE(a.east_deg <= b.west_deg || b.east_deg <= a.west_deg ||
                    a.south_deg >= b.north_deg || b.south_deg >= a.north_deg);
    }
}

TEST(MapDetails, AreNoneWithoutMeasurements) {
    EXPECT_THAT(densest_areas({}, country, room), IsEmpty());
}

} // namespace
} // namespace macadam::testing
