#include "driven_chunks.hpp"

#include "app/pipeline/pipeline.hpp"
#include "estimator/events/event_detection.hpp"
#include "estimator/iri/iri.hpp"
#include "estimator/motion/trip_motion.hpp"
#include "estimator/simulation/road_surface.hpp"
#include "estimator/simulation/simulated_car.hpp"
#include "mapping/network/build_network.hpp"
#include "mapping/passes/trip_cutting.hpp"
#include "storage/settings/scenario_file.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

namespace macadam::testing {
namespace {

/// The mean of what lies within 30 m of each value.
std::vector<double> without_steps(const std::vector<double>& values) {
    constexpr std::size_t reach = 30;
    auto smooth = values;
    for (std::size_t i = reach; i + reach < values.size(); ++i) {
        double sum = 0;
        for (std::size_t k = i - reach; k <= i + reach; ++k) {
            sum += values[k];
        }
        smooth[i] = sum / (2 * reach + 1);
    }
    return smooth;
}

/// Values at each metre that change over `length_m`, of standard deviation `sd` (Gauss-Markov),
/// without steps from metre to metre.
std::vector<double> slow_values(double sd, double length_m, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    const double kept = std::exp(-1 / length_m);
    std::vector<double> values{sd * normal(random)};
    while (values.size() < static_cast<std::size_t>(straight_road_m) + 2) {
        values.push_back(kept * values.back() + std::sqrt(1 - kept * kept) * sd * normal(random));
    }
    return without_steps(values);
}

double value_at(const std::vector<double>& values, double at_m) {
    const double held = std::clamp(at_m, 0.0, static_cast<double>(values.size()) - 2);
    const auto i = static_cast<std::size_t>(held);
    return std::lerp(values[i], values[i + 1], held - static_cast<double>(i));
}

/// A way that leads east from the middle of nowhere.
RoadNetwork straight_way() {
    constexpr double m_per_deg = 111195; // on the equator
    Way way{.id = 1, .name = "", .highway = "primary", .node_ids = {1, 2}, .line = {}};
    way.line = {{0, 10}, {0, 10 + way_m / m_per_deg}};
    return build_network({way});
}

Motion motion_of(double speed_mps, std::mt19937_64& random) {
    const auto change = slow_values(0.08, 300, random);
    Motion motion{
        .step_s = 0.01, .travel_m = {}, .speed_mps = {}, .acc_mps2 = {}, .yaw_rate_radps = {}};
    for (double travel_m = 0; travel_m < straight_road_m - 5;) {
        const double v = speed_mps * (1 + std::clamp(value_at(change, travel_m), -0.2, 0.2));
        motion.travel_m.push_back(travel_m);
        motion.speed_mps.push_back(v);
        motion.yaw_rate_radps.push_back(0);
        travel_m += v * motion.step_s;
    }
    for (std::size_t i = 0; i < motion.speed_mps.size(); ++i) {
        const auto next = std::min(i + 1, motion.speed_mps.size() - 1);
        const auto before = i == 0 ? 0 : i - 1;
        motion.acc_mps2.push_back((motion.speed_mps[next] - motion.speed_mps[before]) /
                                  (motion.step_s * static_cast<double>(next - before)));
    }
    return motion;
}

RoadUnderWheels
under(const RoadSurface& surface, double half_track_m, const std::vector<double>& wander_m) {
    RoadUnderWheels road;
    for (double at_m = 0; at_m < straight_road_m; at_m += road.step_m) {
        const double aside_m = value_at(wander_m, at_m);
        road.left_m.push_back(
            static_cast<float>(elevation_m(surface, at_m, aside_m + half_track_m)));
        road.right_m.push_back(
            static_cast<float>(elevation_m(surface, at_m, aside_m - half_track_m)));
    }
    return road;
}

Vehicle wrong_by_5_percent(const CarRecipe& recipe, std::mt19937_64& random) {
    std::normal_distribution<double> error{1, 0.05};
    auto vehicle = recipe.vehicle;
    vehicle.gain = 1;
    vehicle.one_axle_gain = 0.72; // docs/method/identification.md
    auto& car = vehicle.half_car;
    car.antiroll_n_per_m = recipe.antiroll_n_per_m;
    for (double* value :
         {&car.ms_kg, &car.mu_kg, &car.ks_n_per_m, &car.cs_ns_per_m, &car.kt_n_per_m}) {
        *value *= error(random);
    }
    return vehicle;
}

TripLog log_of(const Motion& motion, const ImuReadings& imu, double scale) {
    TripLog trip;
    trip.meta.frame = Frame::flu;
    trip.meta.frame_stated = true;
    trip.meta.speed_scale = 1;
    trip.acc.t_s = trip.gyro.t_s = imu.t_s;
    for (std::size_t i = 0; i < imu.t_s.size(); ++i) {
        trip.acc.x.push_back(imu.acc_mps2[i][0]);
        trip.acc.y.push_back(imu.acc_mps2[i][1]);
        trip.acc.z.push_back(imu.acc_mps2[i][2]);
        trip.gyro.x.push_back(imu.gyro_radps[i][0]);
        trip.gyro.y.push_back(imu.gyro_radps[i][1]);
        trip.gyro.z.push_back(imu.gyro_radps[i][2]);
    }
    for (std::size_t i = 0; i < motion.travel_m.size(); i += 2) {
        trip.speed.t_s.push_back(static_cast<double>(i) * motion.step_s);
        trip.speed.speed_mps.push_back(static_cast<float>(scale * motion.speed_mps[i]));
    }
    trip.rows.resize(imu.t_s.size());
    return trip;
}

/// As a matcher would give it, a piece each 10 m, wrong by the place's error.
MatchedTrace matched_along(const Motion& motion,
                           const Odometer& odometer,
                           const std::vector<double>& place_error_m,
                           double told_sd_m) {
    struct Knot {
        double t_s;
        double offset_m;
    };
    std::vector<Knot> knots;
    double next_m = 40;
    for (std::size_t i = 0; i < motion.travel_m.size(); ++i) {
        const double at_m = motion.travel_m[i];
        const double offset_m = at_m + value_at(place_error_m, at_m) - way_begins_m;
        if (at_m >= next_m) {
            next_m += 10;
            if (offset_m > 0 && offset_m < way_m) {
                knots.push_back({static_cast<double>(i) * motion.step_s, offset_m});
            }
        }
    }
    MatchedTrace matched;
    for (std::size_t i = 1; i < knots.size(); ++i) {
        matched.push_back({.kind = IntervalKind::road,
                           .edge = EdgeId{0},
                           .from_travel_m = odometer.travel_m(knots[i - 1].t_s),
                           .to_travel_m = odometer.travel_m(knots[i].t_s),
                           .from_offset_m = knots[i - 1].offset_m,
                           .to_offset_m = knots[i].offset_m,
                           .t_enter_s = knots[i - 1].t_s,
                           .t_leave_s = knots[i].t_s,
                           .confidence = 1,
                           .reason = "",
                           .offset_sd_m = told_sd_m});
    }
    return matched;
}

std::vector<double> true_mri(const RoadSurface& surface, const RoadNetwork& roads) {
    const auto paths = wheel_paths(surface);
    const auto left = rectified_stroke_mm_per_m(paths.left_m, paths.step_m);
    const auto right = rectified_stroke_mm_per_m(paths.right_m, paths.step_m);
    std::vector<double> mri;
    for (const auto& segment : segments_of(roads, EdgeId{0})) {
        const auto from = static_cast<std::size_t>((way_begins_m + segment.from_m) / paths.step_m);
        const auto to = static_cast<std::size_t>((way_begins_m + segment.to_m) / paths.step_m);
        double sum = 0;
        for (auto i = from; i < to; ++i) {
            sum += static_cast<double>(left[i] + right[i]) / 2;
        }
        mri.push_back(sum / static_cast<double>(to - from));
    }
    return mri;
}

PipelineConfig config_of(bool smoother) {
    PipelineConfig config;
    config.estimator.method = smoother ? Method::smoother : Method::kf;
    config.estimator.tracks = false; // as `import` does
    config.estimator.profile = true;
    config.stretch.samples_a_metre = smoother ? 2.6 : 0;
    return config;
}

std::vector<RoadEvent> events_in(const IriTrace& roughness) {
    std::vector<RoadEvent> events;
    for (const auto& run : roughness.runs) {
        auto profile = run.profile;
        if (run.left_mm_per_m.empty()) { // as passes_of
            profile.left_m.clear();
            profile.right_m.clear();
        }
        std::ranges::move(detect_events(profile), std::back_inserter(events));
    }
    return events;
}

std::vector<TrueHole> holes_of(const RoadRecipe& recipe, std::uint64_t seed) {
    std::vector<TrueHole> holes;
    for (const auto& hole : potholes_on(straight_road_m, recipe, seed)) {
        holes.push_back({hole.from_m + hole.length_m / 2 - way_begins_m, hole});
    }
    return holes;
}

ChunkDrive driven(const FleetCarRecipe& car,
                  const RoadSurface& surface,
                  const RoadNetwork& roads,
                  const ChunkScenario& scenario,
                  bool phone,
                  std::mt19937_64& random) {
    std::uniform_real_distribution<double> speed_kmh{35, 95};
    std::normal_distribution<double> scale{1, 0.005};
    const auto motion = motion_of(speed_kmh(random) / 3.6, random);
    ChunkDrive drive;
    drive.half_track_m = car.car.vehicle.half_car.l_m;
    drive.aside_m = slow_values(0.15, 200, random);
    const auto road = under(surface, drive.half_track_m, drive.aside_m);
    const auto imu = simulate_imu(car.car, car.imu, road, motion, random());
    const auto vehicle = wrong_by_5_percent(car.car, random);
    const auto config = config_of(scenario.smoother);
    const auto log = log_of(motion, imu, scale(random));
    const auto trace = trace_of(log, motion_of(log), vehicle, config);
    const double sd_m = phone ? scenario.phones_place_sd_m : scenario.place_sd_m;
    const double told_sd_m = scenario.phones_place_sd_m > 0 ? sd_m : 0;
    drive.place_error_m = slow_values(sd_m, scenario.place_length_m, random);
    const auto matched = matched_along(motion, trace.odometer, drive.place_error_m, told_sd_m);
    auto cut = cut_trip(trace.roughness, matched, roads, vehicle, config.pass);
    for (const auto& driven : cut.passes) {
        drive.passes.push_back(driven.pass);
    }
    drive.events = place_events(events_in(trace.roughness), cut.passes);
    drive.traces = std::move(cut.traces);
    return drive;
}

} // namespace

double TrueHole::depth_mm() const {
    return 1000 * hole.depth_m * hole.part_at(hole.lateral_m > 0 ? wheel_path_m : -wheel_path_m);
}

double TrueHole::met_mm(const ChunkDrive& drive) const {
    const double aside_m = value_at(drive.aside_m, at_m + way_begins_m);
    return 1000 * hole.depth_m *
           std::max(hole.part_at(aside_m + drive.half_track_m),
                    hole.part_at(aside_m - drive.half_track_m));
}

DrivenChunks driven_chunks(const ChunkScenario& scenario) {
    std::mt19937_64 random{scenario.seed};
    const auto cars = parse_recipe("", "the sample recipe").cars;
    const RoadRecipe recipe{.iri_mm_per_m = scenario.iri_mm_per_m,
                            .patches_per_km = scenario.patches_per_km,
                            .potholes_per_km = scenario.potholes_per_km};
    const auto surface = make_surface(recipe, straight_road_m, scenario.seed);
    DrivenChunks chunks{.holes = holes_of(recipe, scenario.seed),
                        .roads = straight_way(),
                        .drives = {},
                        .true_mri = {}};
    chunks.true_mri = true_mri(surface, chunks.roads);
    for (std::size_t i = 0; i < scenario.passes; ++i) {
        const bool phone = scenario.phones_place_sd_m > 0 && i % 2 == 1;
        chunks.drives.push_back(
            driven(cars[i % cars.size()], surface, chunks.roads, scenario, phone, random));
    }
    return chunks;
}

} // namespace macadam::testing
