#include "mapping/geometry/area.hpp"

#include <gtest/gtest.h>

#include <random>

using namespace macadam;

namespace {

std::vector<GeoPoint> square(double south_deg, double west_deg, double side_deg) {
    return {{south_deg, west_deg},
            {south_deg, west_deg + side_deg},
            {south_deg + side_deg, west_deg + side_deg},
            {south_deg + side_deg, west_deg}};
}

} // namespace

TEST(Area, LeavesItsHolesOut) {
    const Area area{{{square(0, 0, 10), square(4, 4, 2)}}};
    EXPECT_TRUE(area.contains({1, 1}));
    EXPECT_TRUE(area.contains({5, 7}));
    EXPECT_FALSE(area.contains({5, 5}));
    EXPECT_FALSE(area.contains({5, 11}));
    EXPECT_FALSE(area.contains({-1, 5}));
}

TEST(Area, IsTheUnionOfPolygonsThatOverlap) {
    const Area area{{{square(0, 0, 10)}, {square(5, 5, 10)}}};
    for (const auto& inside : {GeoPoint{1, 1}, GeoPoint{7, 7}, GeoPoint{14, 14}}) {
        EXPECT_TRUE(area.contains(inside)) << inside.lat_deg;
    }
    EXPECT_FALSE(area.contains({2, 12}));
}

TEST(Area, HasTheLinesThatCrossItWithoutAPointInside) {
    const Area area{{{square(0, 0, 1)}}};
    const std::vector<GeoPoint> across{{0.5, -1}, {0.5, 2}};
    const std::vector<GeoPoint> beside{{1.5, -1}, {1.5, 2}};
    const std::vector<GeoPoint> past_a_corner{{-0.5, 0.9}, {0.5, 1.9}};
    EXPECT_TRUE(area.intersects(across));
    EXPECT_FALSE(area.intersects(beside));
    EXPECT_FALSE(area.intersects(past_a_corner));
}

TEST(Area, IsFoundOnBothSidesOfTheAntimeridian) {
    const Area area{{{square(0, 179, 1)}, {square(0, -180, 1)}}};
    const std::vector<GeoPoint> over{{0.5, 179.9}, {0.5, -179.9}};
    const std::vector<GeoPoint> elsewhere{{2, 179.9}, {2, -179.9}};
    EXPECT_TRUE(area.intersects(over));
    EXPECT_FALSE(area.intersects(elsewhere));
    EXPECT_FALSE(area.contains({0.5, 0}));
}

TEST(Area, OfManySidesIsTheSameAsAllItsSidesTested) {
    // A star with 3000 sides, so that it has many bands; the oracle is its equation.
    constexpr int points = 3000;
    constexpr double turn = 6.283185307179586;
    const auto radius = [](double angle) { return 2 + std::cos(9 * angle); };
    std::vector<GeoPoint> ring;
    for (int i = 0; i < points; ++i) {
        const double angle = turn * i / points;
        ring.push_back({radius(angle) * std::sin(angle), radius(angle) * std::cos(angle)});
    }
    const Area area{{{ring}}};
    std::mt19937 random{1};
    std::uniform_real_distribution<double> in{-3.5, 3.5};
    int inside = 0;
    for (int i = 0; i < 5000; ++i) {
        const GeoPoint at{in(random), in(random)};
        const double away = std::hypot(at.lat_deg, at.lon_deg);
        const double border = radius(std::atan2(at.lat_deg, at.lon_deg));
        if (std::abs(away - border) > 1e-3) { // the polygon cuts corners by less
            EXPECT_EQ(area.contains(at), away < border);
            inside += away < border ? 1 : 0;
        }
    }
    EXPECT_GT(inside, 1000);
}

TEST(Area, OfManyLongSidesTakesMemoryBySides) {
    // A comb of 200,000 sides from south to north: in each of 4,096 bands they would take 33 GB.
    std::vector<GeoPoint> ring;
    for (int i = 0; i < 200'000; ++i) {
        ring.push_back({i % 2 == 0 ? 0.0 : 1.0, i * 1e-5});
    }
    ring.push_back({-0.5, 1});
    const Area area{{{ring}}};
    EXPECT_TRUE(area.contains({-0.1, 1}));
    EXPECT_FALSE(area.contains({0.9, 1e-7}));
}

TEST(Area, WithoutPolygonsIsEmpty) {
    EXPECT_TRUE(is_empty(Area{{}}.box()));
    EXPECT_TRUE(is_empty(Area{{{{{0, 0}, {1, 1}}}}}.box()));
    EXPECT_FALSE(Area{{}}.contains({0, 0}));
}
