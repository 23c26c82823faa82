#include "mapping/simulation/driven_path.hpp"

#include "mapping/simulation/road_under_path.hpp"
#include "support/roads/road_art.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace macadam;
using namespace macadam::testing;

namespace {

DrivingRecipe steady() {
    DrivingRecipe driving;
    driving.wander_m = 0;
    return driving;
}

RoadArt straight() {
    return road_art("A---------B", 100, {"AB"}); // 1000 m eastwards
}

RoadArt corner() {
    return road_art(R"(
        A-----B
              |
              C
    )",
                    100,
                    {"ABC"});
}

/// A level sheet at a height.
RoadSurface sheet(double length_m, float height_m) {
    RoadSurface surface;
    surface.step_m = 0.05;
    surface.line_lateral_m = {-1.5F, -0.5F, 0.5F, 1.5F};
    const auto stations = static_cast<std::size_t>(length_m / surface.step_m) + 1;
    surface.elevation_m.assign(4, std::vector<float>(stations, height_m));
    return surface;
}

} // namespace

TEST(DrivenPath, KeepsToItsLane) {
    const auto art = straight();
    for (const bool right : {true, false}) {
        auto driving = steady();
        driving.right_hand = right;
        driving.lane_offset_m = 1.75;
        const auto path = driven_path(art.roads, {edge_between(art, 'A', 'B')}, driving, 1);
        const auto at = path.plane.to_geo(path.points[path.points.size() / 2]);
        const double north_m = distance_m(at, {art.places.at('A').lat_deg, at.lon_deg}) *
                               (at.lat_deg > art.places.at('A').lat_deg ? 1 : -1);
        EXPECT_NEAR(north_m, right ? -1.75 : 1.75, 0.002); // a parallel is not quite straight
    }
}

TEST(DrivenPath, TravelsAStraightRoadsLength) {
    const auto art = straight();
    const auto path = driven_path(art.roads, {edge_between(art, 'A', 'B')}, steady(), 1);
    EXPECT_NEAR(path.travel_m.back() / path.route_m.back(), 1, 2e-6); // as good as the plane
}

TEST(DrivenPath, TurnsByTheAngleOfItsCorner) {
    const auto art = corner();
    const auto forth =
        driven_path(art.roads, {edge_of(LinkId{0}, true)}, steady(), 1); // right by 90 degrees
    const auto back = driven_path(art.roads, {edge_of(LinkId{0}, false)}, steady(), 1);
    const auto turned = [](const DrivenPath& path) {
        double sum = 0;
        for (std::size_t i = 1; i + 1 < path.points.size(); ++i) {
            sum += path.curvature_per_m[i] * (path.travel_m[i + 1] - path.travel_m[i - 1]) / 2;
        }
        return sum;
    };
    EXPECT_NEAR(turned(forth), -std::numbers::pi / 2, 0.03);
    EXPECT_NEAR(turned(back), std::numbers::pi / 2, 0.03);
}

TEST(DrivenPath, IsShorterOnTheInsideOfACorner) {
    const auto art = corner();
    const auto inside = driven_path(art.roads, {edge_of(LinkId{0}, true)}, steady(), 1);
    const auto outside = driven_path(art.roads, {edge_of(LinkId{0}, false)}, steady(), 1);
    // Parallel curves differ by their distance times the angle; ours are rounded each by itself.
    EXPECT_NEAR(
        outside.travel_m.back() - inside.travel_m.back(), 2 * 1.75 * std::numbers::pi / 2, 1.5);
}

TEST(DrivenPath, LooksWhereItGoes) {
    const auto art = straight();
    const auto path = driven_path(art.roads, {edge_of(LinkId{0}, false)}, steady(), 1);
    EXPECT_NEAR(place_at(path, 500).heading.east_m, -1, 1e-9);
}

TEST(DrivenPath, WandersToBothSidesAsFarAsStated) {
    const auto art = road_art("A---------B", 3000, {"AB"});
    auto driving = steady();
    driving.wander_m = 0.2;
    driving.wander_length_m = 200;
    const auto path = driven_path(art.roads, {edge_of(LinkId{0}, true)}, driving, 3);
    double squares = 0;
    std::ptrdiff_t left = 0;
    for (const double wander_m : path.wander_m) {
        left += wander_m > 0 ? 1 : 0;
        squares += wander_m * wander_m;
    }
    const auto count = static_cast<double>(path.wander_m.size());
    const double sd = std::sqrt(squares / count);
    EXPECT_NEAR(sd, 0.2, 0.04); // 150 independent ones, a tenth smoothed away
    EXPECT_NEAR(static_cast<double>(left) / count, 0.5, 0.12);
}

TEST(RoadUnderWheels, IsTheLanesAtTheirStations) {
    const auto art = straight();
    const auto path = driven_path(art.roads, {edge_of(LinkId{0}, true)}, steady(), 1);
    auto ramp = sheet(1000, 0);
    for (auto& line : ramp.elevation_m) {
        for (std::size_t i = 0; i < line.size(); ++i) {
            line[i] = static_cast<float>(i) * 1e-4F;
        }
    }
    const auto surface = std::make_shared<const RoadSurface>(std::move(ramp));
    const auto road = road_under(
        path, [&](const Lane&) { return surface; }, 0.75);
    // 500 m along: station 500 m is at 1 m of height there; travel and route differ by 1e-6.
    EXPECT_NEAR(road.left_m[10000], road.left_m[0] + 1.0, 1e-4);
}

TEST(RoadUnderWheels, HasNoStepWhereACarTurnsOffALane) {
    const auto art = road_art(R"(
        A-----B-----C
              |
              D
    )",
                              100,
                              {"ABC", "BD"});
    const std::vector route{edge_between(art, 'A', 'B'), edge_between(art, 'B', 'D')};
    const auto path = driven_path(art.roads, route, steady(), 1);
    const auto low = std::make_shared<const RoadSurface>(sheet(1300, 0));
    const auto high = std::make_shared<const RoadSurface>(sheet(1300, 0.1F));
    const auto road = road_under(
        path, [&](const Lane& lane) { return lane.way == 0 ? low : high; }, 0.75);
    float steepest = 0;
    for (std::size_t i = 1; i < road.left_m.size(); ++i) {
        steepest = std::max(steepest, std::abs(road.left_m[i] - road.left_m[i - 1]));
    }
    // 0.1 m over 100 m, by a cubic: 1.5 mm/m at most, here in steps of 0.05 m of a path that cuts
    // its corner to a third.
    EXPECT_LT(steepest, 0.0003F);
    EXPECT_NEAR(road.left_m.back(), 0.1F, 1e-6);
}
