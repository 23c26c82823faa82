#include "mapping/simulation/lane.hpp"

#include "estimator/iri/iri.hpp"
#include "estimator/simulation/random.hpp"
#include "estimator/simulation/road_features.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace macadam {
namespace {

/// Minimum length of a surface, for ways of a few centimetres.
constexpr double shortest_lane_m = 2;

// Purposes of seeds, so that no two draws of a way are the same.
enum Draw : std::uint64_t { draw_share = 1, draw_level = 2, draw_surface = 3, draw_waves = 4 };

std::uint64_t bits_of(std::int64_t id) {
    return static_cast<std::uint64_t>(id);
}

bool fits(const RoadRule& rule, std::size_t number, const WayView& way, std::uint64_t seed) {
    const bool right_class = rule.highways.empty() ||
                             std::ranges::find(rule.highways, way.highway) != rule.highways.end();
    if (!right_class || (rule.way_id && *rule.way_id != way.id) ||
        (!rule.name.empty() && rule.name != way.name)) {
        return false;
    }
    return Random{seed_of({seed, draw_share, number, bits_of(way.id)})}.uniform() < rule.share;
}

/// Quantiles that a lane has of the distributions of the rules, 0 to 1.
struct LaneDraws {
    double level, long_waves, short_waves;
};

LaneDraws draws_of(const WayView& way, bool forward, std::uint64_t seed) {
    Random waves{seed_of({seed, draw_waves, bits_of(way.id)})};
    const double long_waves = waves.uniform();
    const double short_waves = waves.uniform();
    return {Random{seed_of({seed, draw_level, bits_of(way.id), forward})}.uniform(),
            long_waves,
            short_waves};
}

double log_uniform(const Bounds& bounds, double quantile) {
    return bounds.low * std::pow(bounds.high / bounds.low, quantile);
}

RoadRecipe with_rule(RoadRecipe road, const RoadRule& rule, const LaneDraws& draws) {
    if (rule.iri_mm_per_m) {
        road.iri_mm_per_m = rule.iri_mm_per_m->low +
                            draws.level * (rule.iri_mm_per_m->high - rule.iri_mm_per_m->low);
    }
    if (rule.long_wave_ratio) {
        road.long_wave_ratio = log_uniform(*rule.long_wave_ratio, draws.long_waves);
    }
    if (rule.short_wave_ratio) {
        road.short_wave_ratio = log_uniform(*rule.short_wave_ratio, draws.short_waves);
    }
    road.waviness = rule.waviness.value_or(road.waviness);
    road.level_sd = rule.level_sd.value_or(road.level_sd);
    road.level_length_m = rule.level_length_m.value_or(road.level_length_m);
    road.coherency_length_m = rule.coherency_length_m.value_or(road.coherency_length_m);
    road.joint_spacing_m = rule.joint_spacing_m.value_or(road.joint_spacing_m);
    road.joint_step_mm = rule.joint_step_mm.value_or(road.joint_step_mm);
    road.patches_per_km = rule.patches_per_km.value_or(road.patches_per_km);
    road.potholes_per_km = rule.potholes_per_km.value_or(road.potholes_per_km);
    return road;
}

/// Averages the strokes of a lane between two stations; uses the nearest one if there is none
/// between.
double mean_between(std::span<const float> strokes, double step_m, double from_m, double to_m) {
    const auto last = static_cast<double>(strokes.size() - 1);
    const auto first = static_cast<std::size_t>(std::clamp(std::round(from_m / step_m), 0.0, last));
    const auto end = std::clamp(static_cast<std::size_t>(std::max(0.0, std::round(to_m / step_m))),
                                first + 1,
                                strokes.size());
    double sum = 0;
    for (auto i = first; i < end; ++i) {
        sum += strokes[i];
    }
    return sum / static_cast<double>(end - first);
}

std::vector<double> mean_profile(const WheelPaths& paths) {
    std::vector<double> mean_m(paths.left_m.size());
    for (std::size_t i = 0; i < mean_m.size(); ++i) {
        mean_m[i] = (paths.left_m[i] + paths.right_m[i]) / 2;
    }
    return mean_m;
}

} // namespace

std::vector<Lane> drivable_lanes(const RoadNetwork& roads) {
    std::vector<Lane> lanes;
    for (std::uint32_t way = 0; way < way_count(roads); ++way) {
        const auto oneway = way_at(roads, way).oneway;
        if (oneway != Oneway::backward) {
            lanes.push_back({way, true});
        }
        if (oneway != Oneway::forward) {
            lanes.push_back({way, false});
        }
    }
    return lanes;
}

double whole_mm(double length_m) {
    return std::round(length_m * 1000) / 1000;
}

double lane_length_m(const RoadNetwork& roads, const Lane& lane) {
    return whole_mm(way_at(roads, lane.way).along_m.back());
}

RoadRecipe
road_recipe(const FleetScenario& recipe, const WayView& way, bool forward, std::uint64_t seed) {
    const LaneDraws draws = draws_of(way, forward, seed);
    RoadRecipe road;
    for (std::size_t i = 0; i < recipe.roads.size(); ++i) {
        if (fits(recipe.roads[i], i, way, seed)) {
            road = with_rule(road, recipe.roads[i], draws);
        }
    }
    return road;
}

namespace {

std::uint64_t surface_seed(const WayView& way, const Lane& lane, std::uint64_t seed) {
    return seed_of({seed, draw_surface, bits_of(way.id), lane.forward});
}

} // namespace

RoadSurface lane_surface(const FleetScenario& recipe,
                         const RoadNetwork& roads,
                         const Lane& lane,
                         std::uint64_t seed) {
    const auto way = way_at(roads, lane.way);
    return make_surface(road_recipe(recipe, way, lane.forward, seed),
                        std::max(lane_length_m(roads, lane), shortest_lane_m),
                        surface_seed(way, lane, seed));
}

std::vector<PotholeTruth> lane_potholes(const FleetScenario& recipe,
                                        const RoadNetwork& roads,
                                        const Lane& lane,
                                        const RoadSurface& surface,
                                        std::uint64_t seed) {
    const auto way = way_at(roads, lane.way);
    const double length_m = lane_length_m(roads, lane);
    std::vector<PotholeTruth> truth;
    for (const auto& hole : potholes_on(surface.length_m(),
                                        road_recipe(recipe, way, lane.forward, seed),
                                        surface_seed(way, lane, seed))) {
        const double station_m = hole.from_m + hole.length_m / 2;
        const bool is_left = hole.lateral_m > 0;
        truth.push_back(
            {.way_id = way.id,
             .forward = lane.forward,
             .at_m = lane.forward ? station_m : length_m - station_m,
             .length_m = hole.length_m,
             .depth_m = hole.depth_m * hole.part_at(is_left ? wheel_path_m : -wheel_path_m),
             .is_left = is_left});
    }
    std::ranges::sort(
        truth, {}, [&](const PotholeTruth& hole) { return lane.forward ? hole.at_m : -hole.at_m; });
    return truth;
}

std::vector<SegmentTruth>
lane_truth(const RoadNetwork& roads, const Lane& lane, const RoadSurface& surface) {
    const auto paths = wheel_paths(surface);
    const auto left = rectified_stroke_mm_per_m(paths.left_m, paths.step_m);
    const auto right = rectified_stroke_mm_per_m(paths.right_m, paths.step_m);
    const auto middle = rectified_stroke_mm_per_m(mean_profile(paths), paths.step_m);
    const double length_m = lane_length_m(roads, lane);

    std::vector<SegmentTruth> truth;
    const auto way = way_at(roads, lane.way);
    for (auto number = way.first_link; number < way.past_link; ++number) {
        const auto link = link_at(roads, LinkId{number});
        const double segment_m = (link.to_m - link.from_m) / link.segments;
        for (std::uint32_t i = 0; i < link.segments; ++i) {
            const double from_m = link.from_m + i * segment_m;
            const double to_m = i + 1 == link.segments ? link.to_m : from_m + segment_m;
            const double enter_m = lane.forward ? from_m : length_m - to_m;
            const double leave_m = lane.forward ? to_m : length_m - from_m;
            const auto mean = [&](std::span<const float> strokes) {
                return mean_between(strokes, paths.step_m, enter_m, leave_m);
            };
            truth.push_back({{way.id, lane.forward, link.first_segment + i},
                             from_m,
                             to_m,
                             mean(left),
                             mean(right),
                             (mean(left) + mean(right)) / 2,
                             mean(middle)});
        }
    }
    return truth;
}

} // namespace macadam
