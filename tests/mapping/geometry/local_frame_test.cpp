#include "mapping/geometry/local_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace macadam {
namespace {

TEST(LocalFrame, PutsItsOriginAtZero) {
    const auto at = LocalFrame{{47.5, 8.5}}.to_local(GeoPoint{47.5, 8.5});
    EXPECT_NEAR(at.east_m, 0, 1e-6); // rounding at the earth's radius
    EXPECT_NEAR(at.north_m, 0, 1e-6);
}

TEST(LocalFrame, MeasuresAMinuteOfLatitudeAsTheTablesDo) {
    // Meridian arc of 1' at 45 degrees on WGS 84: 1852.2 m (mean of the two neighbouring minutes).
    const auto at = LocalFrame{{45, 7}}.to_local(GeoPoint{45 + 1.0 / 60, 7});
    EXPECT_NEAR(at.north_m, 1852.2, 0.2);
}

TEST(LocalFrame, AgreesWithDistancesOnTheEllipsoid) {
    const GeoPoint origin{60, 25};
    for (const GeoPoint& there : {GeoPoint{60.02, 25.03}, GeoPoint{59.97, 25.01}}) {
        const auto at = LocalFrame{origin}.to_local(there);
        EXPECT_NEAR(std::hypot(at.east_m, at.north_m), distance_m(origin, there), 0.01);
    }
}

TEST(LocalFrame, ComesBackFromThePlane) {
    const LocalFrame frame{{-33.9, 151.2}};
    for (const PointEn& there : {PointEn{30000, -20000}, PointEn{-1, 5}, PointEn{0, 80000}}) {
        const auto back = frame.to_local(frame.to_geo(there));
        EXPECT_NEAR(back.east_m, there.east_m, 1e-4); // 0.1 mm
        EXPECT_NEAR(back.north_m, there.north_m, 1e-4);
    }
}

TEST(LocalFrame, FindsPointsOfAnotherContinent) {
    const LocalFrame frame{{44, -29}};
    for (const GeoPoint& there : {GeoPoint{48.2, 16.4}, GeoPoint{40.7, -74}, GeoPoint{-10, -35}}) {
        EXPECT_LT(distance_m(frame.to_geo(frame.to_local(there)), there), 0.001);
    }
}

} // namespace
} // namespace macadam
