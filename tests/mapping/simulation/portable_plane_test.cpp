#include "mapping/simulation/portable_plane.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace macadam;

namespace {

double length_m(const PointEn& step) {
    return std::hypot(step.east_m, step.north_m);
}

} // namespace

TEST(ExactPlane, MeasuresAsTheEllipsoidDoes) {
    const GeoPoint origin{48.41, 15.6};
    const ExactPlane plane{origin};
    for (const double north_deg : {-0.04, 0.0, 0.04}) { // 4.4 km
        const GeoPoint a{origin.lat_deg + north_deg, origin.lon_deg - 0.05};
        const GeoPoint b{origin.lat_deg + north_deg + 0.001, origin.lon_deg - 0.045};
        const double planar_m = length_m(plane.metres(plane.to_plane(a), plane.to_plane(b)));
        EXPECT_NEAR(planar_m / distance_m(a, b), 1, 2e-6); // second order of 4.4 km: 1e-6
    }
}

TEST(ExactPlane, LeadsBackToWherePointsCameFrom) {
    const ExactPlane plane{{-33.9, 179.99}};
    const GeoPoint beyond{-33.91, -179.98};
    const auto back = plane.to_geo(plane.to_plane(beyond));
    EXPECT_NEAR(back.lat_deg, beyond.lat_deg, 1e-12);
    EXPECT_NEAR(back.lon_deg, beyond.lon_deg, 1e-12);
}
