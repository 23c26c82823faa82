#include "mapping/simulation/speed_profile.hpp"

#include "estimator/common/error.hpp"
#include "estimator/simulation/random.hpp"
#include "mapping/simulation/route.hpp"
#include "mapping/simulation/smoothing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace macadam {
namespace {

constexpr double step_s = 0.01;
constexpr double margin_m = 8;          // of road behind the rear and ahead of the front axle
constexpr double crawl_mps = 1.5;       // in the tightest turn
constexpr double rest_s = 6;            // at the start and the end of a trip
constexpr double stop_clearance_m = 20; // between two stops
constexpr std::size_t pedal_box = 35;   // two boxes of 0.7 s: duration of a pedal movement
constexpr double mood_sd = 0.04;        // variation of a driver's speed on an open road
constexpr double mood_length_m = 400;

enum Draw : std::uint64_t { draw_driver = 21, draw_mood = 22, draw_stops = 23 };

struct Stop {
    double route_m;
    double duration_s;
};

/// Returns the possible stops: ends of edges at junctions without free flow.
std::vector<Stop> stops_of(const RoadNetwork& roads,
                           const std::vector<EdgeId>& route,
                           const DrivingRecipe& driving,
                           std::uint64_t seed) {
    constexpr std::size_t min_ways_on = 3;
    Random random{seed_of({seed, draw_stops})};
    std::vector<Stop> stops;
    double route_m = 0;
    for (std::size_t i = 0; i + 1 < route.size(); ++i) {
        const auto link = link_at(roads, route[i]);
        route_m += whole_mm(link.to_m) - whole_mm(link.from_m);
        const bool junction = out_edges(roads, to_node(roads, route[i])).size() >= min_ways_on;
        const bool chosen = random.uniform() < driving.stop_share;
        const double duration_s = random.uniform(driving.stop_s.low, driving.stop_s.high);
        const bool clear = stops.empty() || route_m - stops.back().route_m > stop_clearance_m;
        if (junction && chosen && clear && !flows_freely(way_of(roads, route[i]).highway)) {
            stops.push_back({route_m, duration_s});
        }
    }
    return stops;
}

/// Returns the speed allowed by road, curve and driver at each point of the path.
std::vector<double> allowed_mps(const DrivenPath& path,
                                const RoadNetwork& roads,
                                const DrivingRecipe& driving,
                                std::uint64_t seed) {
    const double factor =
        Random{seed_of({seed, draw_driver})}.uniform(driving.driver.low, driving.driver.high);
    const auto mood = boxed(
        slow_noise(path.route_m.size(), mood_sd, mood_length_m, seed_of({seed, draw_mood})), 20);
    std::vector<double> speed_mps;
    std::size_t piece = 0;
    for (std::size_t i = 0; i < path.route_m.size(); ++i) {
        while (piece + 1 < path.pieces.size() && path.pieces[piece].to_m <= path.route_m[i]) {
            ++piece;
        }
        const auto highway = way_at(roads, path.pieces[piece].lane.way).highway;
        const double road_mps =
            usual_speed_kmh(driving, highway) / 3.6 * factor * std::max(0.5, 1 + mood[i]);
        const double curve = std::max(std::abs(path.curvature_per_m[i]), 1e-9);
        const double curve_mps = std::max(crawl_mps, std::sqrt(driving.lateral_mps2 / curve));
        speed_mps.push_back(std::min(road_mps, curve_mps));
    }
    return speed_mps;
}

/// Points of the path with their speeds and stop durations.
struct Plan {
    std::vector<double> travel_m;
    std::vector<double> speed_mps;
    std::vector<double> stand_s;
};

/// Selects the driven part of the path and adds its stops.
Plan planned(const DrivenPath& path,
             std::vector<double> speed_mps,
             const std::vector<Stop>& stops) {
    const double last_m = path.travel_m.back() - margin_m;
    Plan plan;
    std::size_t stop = 0;
    for (std::size_t i = 0; i < path.travel_m.size(); ++i) {
        while (stop < stops.size() && stops[stop].route_m < path.route_m[i] - 1) {
            ++stop;
        }
        if (path.travel_m[i] < margin_m || path.travel_m[i] > last_m) {
            continue;
        }
        plan.travel_m.push_back(path.travel_m[i]);
        plan.speed_mps.push_back(speed_mps[i]);
        plan.stand_s.push_back(0);
        const bool here = stop < stops.size() && stops[stop].route_m <= path.route_m[i];
        const bool clear = path.travel_m[i] > margin_m + stop_clearance_m &&
                           path.travel_m[i] < last_m - stop_clearance_m;
        if (here && clear) {
            plan.speed_mps.back() = 0;
            plan.stand_s.back() = stops[stop].duration_s;
        }
        stop += here ? 1 : 0;
    }
    return plan;
}

/// Limits speeds by acceleration and braking: v^2 changes by 2 a per metre.
Plan within_reach(Plan plan, const DrivingRecipe& driving) {
    auto& v = plan.speed_mps;
    v.front() = 0;
    v.back() = 0;
    for (std::size_t i = 1; i < v.size(); ++i) {
        const double gained =
            2 * driving.acceleration_mps2 * (plan.travel_m[i] - plan.travel_m[i - 1]);
        v[i] = std::min(v[i], std::sqrt(v[i - 1] * v[i - 1] + gained));
    }
    for (std::size_t i = v.size() - 1; i-- > 0;) {
        const double lost = 2 * driving.braking_mps2 * (plan.travel_m[i + 1] - plan.travel_m[i]);
        v[i] = std::min(v[i], std::sqrt(v[i + 1] * v[i + 1] + lost));
    }
    return plan;
}

/// Converts to speed over time at equal steps, with constant acceleration between two points of the
/// plan.
std::vector<double> speed_over_time(const Plan& plan) {
    std::vector<double> speed_mps(static_cast<std::size_t>(rest_s / step_s), 0.0);
    double begin_s = static_cast<double>(speed_mps.size()) * step_s;
    const auto fill = [&](double end_s, double from_mps, double to_mps) {
        while (static_cast<double>(speed_mps.size()) * step_s < end_s) {
            const double share =
                (static_cast<double>(speed_mps.size()) * step_s - begin_s) / (end_s - begin_s);
            speed_mps.push_back(from_mps + share * (to_mps - from_mps));
        }
        begin_s = end_s;
    };
    for (std::size_t i = 1; i < plan.travel_m.size(); ++i) {
        const double mean_mps = (plan.speed_mps[i - 1] + plan.speed_mps[i]) / 2;
        const double time_s = (plan.travel_m[i] - plan.travel_m[i - 1]) / mean_mps;
        fill(begin_s + time_s, plan.speed_mps[i - 1], plan.speed_mps[i]);
        if (plan.stand_s[i] > 0) {
            fill(begin_s + plan.stand_s[i], 0, 0);
        }
    }
    speed_mps.insert(speed_mps.end(), static_cast<std::size_t>(rest_s / step_s), 0.0);
    return speed_mps;
}

std::vector<double>
yaw_rates(const DrivenPath& path, std::span<const double> travel_m, std::span<const double> v) {
    std::vector<double> yaw_radps;
    yaw_radps.reserve(travel_m.size());
    std::size_t at = 0;
    for (std::size_t i = 0; i < travel_m.size(); ++i) {
        while (at + 2 < path.travel_m.size() && path.travel_m[at + 1] <= travel_m[i]) {
            ++at;
        }
        const double share = std::clamp((travel_m[i] - path.travel_m[at]) /
                                            (path.travel_m[at + 1] - path.travel_m[at]),
                                        0.0,
                                        1.0);
        const double curvature = path.curvature_per_m[at] +
                                 share * (path.curvature_per_m[at + 1] - path.curvature_per_m[at]);
        yaw_radps.push_back(v[i] * curvature);
    }
    return yaw_radps;
}

Motion motion_of(const DrivenPath& path, double begin_m, std::vector<double> speed_mps) {
    for (int i = 0; i < 2; ++i) {
        speed_mps = boxed(speed_mps, pedal_box);
        for (auto& speed : speed_mps) {
            speed = std::max(0.0, speed); // box sums leave about 1e-16 below 0
        }
    }
    Motion motion{.step_s = step_s,
                  .travel_m = {begin_m},
                  .speed_mps = std::move(speed_mps),
                  .acc_mps2 = {},
                  .yaw_rate_radps = {}};
    const auto& v = motion.speed_mps;
    for (std::size_t i = 0; i < v.size(); ++i) {
        const auto before = i == 0 ? 0 : i - 1;
        const auto after = std::min(i + 1, v.size() - 1);
        motion.acc_mps2.push_back((v[after] - v[before]) /
                                  (static_cast<double>(after - before) * step_s));
        if (i > 0) {
            motion.travel_m.push_back(motion.travel_m.back() + (v[i - 1] + v[i]) / 2 * step_s);
        }
    }
    motion.yaw_rate_radps = yaw_rates(path, motion.travel_m, v);
    return motion;
}

} // namespace

Motion drive_along(const DrivenPath& path,
                   const RoadNetwork& roads,
                   const std::vector<EdgeId>& route,
                   const DrivingRecipe& driving,
                   std::uint64_t seed) {
    constexpr double shortest_m = 60;
    if (path.travel_m.back() < shortest_m) {
        throw InputError{fmt::format("a trip of {:.0f} m was drawn, expected at least {:g} m: the "
                                     "network is too small, or length_km",
                                     path.travel_m.back(),
                                     shortest_m)};
    }
    const auto plan = within_reach(planned(path,
                                           allowed_mps(path, roads, driving, seed),
                                           stops_of(roads, route, driving, seed)),
                                   driving);
    return motion_of(path, plan.travel_m.front(), speed_over_time(plan));
}

} // namespace macadam
