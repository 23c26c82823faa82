#include "render/scene/scale_bar.hpp"

#include "estimator/common/error.hpp"
#include "render/projection/projection.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace macadam::testing {

TEST(ScaleBar, IsAsLongAsItsLabelSays) {
    const auto frame = fitted_frame({16.0, 48.0, 16.1, 48.1}, {0, 0, 1000, 1000});
    const auto bar = scale_bar(metres_per_px(frame, 500), 300, false);
    EXPECT_EQ(bar.label, "2 km");
    const auto west = to_geo(frame, {500, 500});
    const auto east = to_geo(frame, {500 + bar.width_px, 500});
    EXPECT_NEAR(distance_m(west, east), 2000, metres_per_px(frame, 500)); // a pixel
}

TEST(ScaleBar, IsRoundAndFillsAtLeastTwoFifthsOfItsRoom) {
    for (double metres_per_px = 0.05; metres_per_px < 5000; metres_per_px *= 1.13) {
        for (const bool miles : {false, true}) {
            const auto bar = scale_bar(metres_per_px, 200, miles);
            EXPECT_LE(bar.width_px, 200 * (1 + 1e-9));
            EXPECT_GE(bar.width_px, 200 * 0.4 * (1 - 1e-9)) << bar.label; // from 2 to just below 5
        }
    }
}

TEST(ScaleBar, SpeaksOfFeetAndMiles) {
    EXPECT_EQ(scale_bar(1, 200, true).label, "500 ft");
    EXPECT_EQ(scale_bar(10, 200, true).label, "1 mi");
    EXPECT_NEAR(scale_bar(10, 200, true).width_px, 160.9344, 1e-9);
}

TEST(Projection, PutsTheBoxInTheMiddleOfItsRoom) {
    const GeoBox box{16.0, 48.0, 16.4, 48.1};
    const auto frame = fitted_frame(box, {100, 50, 500, 950});
    EXPECT_NEAR(to_pixel(frame, {48.05, 16.0}).x, 100, 1e-6);
    EXPECT_NEAR(to_pixel(frame, {48.05, 16.4}).x, 500, 1e-6);
    const double top = to_pixel(frame, {48.1, 16.2}).y;
    const double bottom = to_pixel(frame, {48.0, 16.2}).y;
    EXPECT_NEAR((top + bottom) / 2, 500, 1e-6);
    EXPECT_LT(top, bottom);
}

TEST(Projection, IsTrueToAnglesOnTheSphere) {
    // Mercator: a small square on the sphere is a square on the picture.
    const auto frame = fitted_frame({10, 60, 11, 61}, {0, 0, 1000, 1000});
    const auto corner = to_pixel(frame, {60.5, 10.5});
    const auto east = to_pixel(frame, {60.5, 10.5 + 1e-4});
    const auto north = to_pixel(frame, {60.5 + 1e-4 * std::cos(60.5 / 180 * M_PI), 10.5});
    EXPECT_NEAR((east.x - corner.x) / (corner.y - north.y), 1, 1e-5); // of the tiny square's size
}

TEST(Projection, TakesAPointForANeighbourhoodOfTwoHundredMetres) {
    const auto frame = fitted_frame({16, 48, 16, 48}, {0, 0, 1000, 1000});
    EXPECT_NEAR(metres_per_px(frame, 500) * 1000, 200, 2); // ellipsoid against sphere: 1 %
}

TEST(Projection, RefusesTheEmptyBox) {
    EXPECT_THAT(
        [] {
            fitted_frame({}, {0, 0, 10, 10});
        },
        ::testing::ThrowsMessage<InputError>(
            "the box of the map is empty, expected west <= east and south <= north"));
}

TEST(Projection, RefusesThePoles) {
    EXPECT_THAT(
        [] {
            fitted_frame({0, 80, 1, 89}, {0, 0, 10, 10});
        },
        ::testing::ThrowsMessage<InputError>(
            "the box of the map is '0,80,1,89', expected longitudes within 180 and "
            "latitudes within 85 degrees"));
}

} // namespace macadam::testing
