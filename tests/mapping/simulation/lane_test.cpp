#include "mapping/simulation/lane.hpp"

#include "estimator/iri/iri.hpp"
#include "support/roads/road_art.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

using namespace macadam;
using namespace macadam::testing;

namespace {

RoadArt street() {
    return road_art("A------B------C", 100, {"ABC"}); // 1400 m
}

FleetScenario recipe_of(std::vector<RoadRule> rules) {
    FleetScenario recipe;
    recipe.roads = std::move(rules);
    return recipe;
}

RoadRule rule(double iri_mm_per_m) {
    RoadRule rule;
    rule.iri_mm_per_m = Bounds{iri_mm_per_m, iri_mm_per_m};
    return rule;
}

WayView way_of(std::int64_t id, const char* highway) {
    WayView way;
    way.id = id;
    way.name = "Main Street";
    way.highway = highway;
    return way;
}

double iri_of(const FleetScenario& recipe, const WayView& way) {
    return road_recipe(recipe, way, true, 1).iri_mm_per_m;
}

} // namespace

TEST(Lane, IsTheSameForEveryCarAndAnotherInTheOtherDirection) {
    const auto art = street();
    const auto recipe = recipe_of({rule(2)});
    const auto first = lane_surface(recipe, art.roads, {0, true}, 1);
    EXPECT_EQ(lane_surface(recipe, art.roads, {0, true}, 1).elevation_m, first.elevation_m);
    EXPECT_NE(lane_surface(recipe, art.roads, {0, false}, 1).elevation_m, first.elevation_m);
    EXPECT_NE(lane_surface(recipe, art.roads, {0, true}, 2).elevation_m, first.elevation_m);
}

TEST(Lane, IsAsLongAsItsWayToTheMillimetre) {
    const auto art = street();
    EXPECT_NEAR(lane_surface(recipe_of({rule(2)}), art.roads, {0, true}, 1).length_m(),
                way_at(art.roads, 0).along_m.back(),
                0.00051);
}

TEST(Lane, OfALaterRuleHasWhatThatSays) {
    auto town = rule(4);
    town.highways = {"residential", "service"};
    auto named = rule(5);
    named.name = "Main Street";
    named.highways = {"service"};
    auto one = rule(6);
    one.way_id = 12;
    const auto recipe = recipe_of({rule(2), town, named, one});
    EXPECT_EQ(iri_of(recipe, way_of(1, "primary")), 2);
    EXPECT_EQ(iri_of(recipe, way_of(1, "residential")), 4);
    EXPECT_EQ(iri_of(recipe, way_of(1, "service")), 5);
    EXPECT_EQ(iri_of(recipe, way_of(12, "service")), 6);
}

TEST(Lane, OfARuleForAShareIsDrawnByItsWay) {
    auto some = rule(5);
    some.share = 0.2;
    const auto recipe = recipe_of({rule(2), some});
    int chosen = 0;
    for (std::int64_t id = 0; id < 2000; ++id) {
        chosen += iri_of(recipe, way_of(id, "primary")) == 5 ? 1 : 0;
    }
    EXPECT_NEAR(chosen, 400, 54); // three standard deviations of a binomial
}

TEST(Lane, DrawsTheBendOfItsSpectrumByItsWayAlike) {
    auto bent = rule(2);
    bent.long_wave_ratio = Bounds{0.5, 8};
    bent.short_wave_ratio = Bounds{0.3, 0.3};
    const auto recipe = recipe_of({bent});
    double sum = 0;
    double square = 0;
    for (std::int64_t id = 0; id < 2000; ++id) {
        const auto way = way_of(id, "primary");
        const auto road = road_recipe(recipe, way, true, 1);
        EXPECT_EQ(road.long_wave_ratio, road_recipe(recipe, way, false, 1).long_wave_ratio);
        EXPECT_EQ(road.short_wave_ratio, 0.3);
        ASSERT_TRUE(*road.long_wave_ratio >= 0.5 && *road.long_wave_ratio <= 8);
        sum += std::log2(*road.long_wave_ratio);
        square += std::pow(std::log2(*road.long_wave_ratio), 2);
    }
    // Uniform from -1 to 3: sd 4 / sqrt(12), known to 2.6 % and 1.2 %; three times that.
    EXPECT_NEAR(sum / 2000, 1, 0.08);
    EXPECT_NEAR(std::sqrt(square / 2000 - std::pow(sum / 2000, 2)), 1.155, 0.042);
    EXPECT_FALSE(road_recipe(recipe_of({rule(2)}), way_of(1, "primary"), true, 1).long_wave_ratio);
}

TEST(LaneTruth, AddsUpToTheIriOfTheWholeLane) {
    const auto art = street();
    for (const bool forward : {true, false}) {
        const auto surface = lane_surface(recipe_of({rule(3)}), art.roads, {0, forward}, 1);
        double left = 0;
        double length_m = 0;
        for (const auto& segment : lane_truth(art.roads, {0, forward}, surface)) {
            left += segment.iri_left * (segment.to_m - segment.from_m);
            length_m += segment.to_m - segment.from_m;
        }
        const auto paths = wheel_paths(surface);
        // Borders of segments fall to the nearest 5 cm: 0.1 % each, and seldom the same way.
        EXPECT_NEAR(left / length_m, iri_mm_per_m(paths.left_m, paths.step_m), 0.01);
    }
}

TEST(LaneTruth, CountsAlongTheWayWhateverTheDirection) {
    const auto art = street();
    auto surface = lane_surface(recipe_of({rule(3)}), art.roads, {0, false}, 1);
    for (auto& line : surface.elevation_m) { // smooth but for the last 30 m that are driven
        for (std::size_t i = 0; i < line.size(); ++i) {
            const double to_end_m = surface.length_m() - static_cast<double>(i) * surface.step_m;
            line[i] = to_end_m < 30 && i % 40 < 20 ? 0.01F : 0.0F;
        }
    }
    const auto truth = lane_truth(art.roads, {0, false}, surface);
    EXPECT_EQ(truth.front().key.index, 0U);
    EXPECT_FALSE(truth.front().key.forward);
    EXPECT_GT(truth.front().mri, 3);
    EXPECT_LT(truth.back().mri, 1e-6);
}

TEST(LaneTruth, HasARowForEachSegmentThatMayBeDriven) {
    const auto art = road_art(R"(
        A------B------C
               |
               D
    )",
                              100,
                              {"ABC", "DB>"});
    std::size_t expected = 0;
    for (std::uint32_t link = 0; link < link_count(art.roads); ++link) {
        for (const bool forward : {true, false}) {
            const auto edge = edge_of(LinkId{link}, forward);
            expected += is_drivable(art.roads, edge) ? segments_of(art.roads, edge).size() : 0;
        }
    }
    std::vector<SegmentKey> keys;
    for (const auto& lane : drivable_lanes(art.roads)) {
        const auto surface = lane_surface(recipe_of({}), art.roads, lane, 1);
        for (const auto& segment : lane_truth(art.roads, lane, surface)) {
            keys.push_back(segment.key);
        }
    }
    EXPECT_EQ(keys.size(), expected);
    EXPECT_TRUE(std::ranges::is_sorted(keys));
}
