#include "mapping/simulation/fleet.hpp"

#include "estimator/common/error.hpp"
#include "estimator/simulation/random.hpp"
#include "estimator/vehicle/vehicle_prior.hpp"
#include "mapping/simulation/driven_path.hpp"
#include "mapping/simulation/gnss_receiver.hpp"
#include "mapping/simulation/road_under_path.hpp"
#include "mapping/simulation/speed_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

enum Draw : std::uint64_t {
    draw_faults = 41,
    draw_knowledge = 42,
    draw_date = 43,
    draw_path = 44,
    draw_speed = 45,
    draw_imu = 46,
    draw_gnss = 47,
    draw_wheels = 48
};

/// A one-axle method sees the mean of both ends of a car; comb filtering by the wheelbase reduces
/// its RMS to about this (docs/method/identification.md).
constexpr double one_axle_gain = 0.72;

std::array<double, 3> three(Random& random, double sd) {
    const double x = random.normal();
    const double y = random.normal();
    const double z = random.normal();
    return {sd * x, sd * y, sd * z};
}

/// Draws a documented parameter with relative error `sd`, limited to 2.5 sd and to a tenth.
double written(Random& random, double truth, double sd) {
    return truth * std::max(0.1, 1 + sd * std::clamp(random.normal(), -2.5, 2.5));
}

/// Returns the vehicle file of a car as it is simulated.
Vehicle true_vehicle(const CarRecipe& car, const ImuRecipe& imu) {
    Vehicle vehicle = car.vehicle;
    vehicle.half_car.antiroll_n_per_m = car.antiroll_n_per_m;
    vehicle.half_car.friction_n = car.friction_n;
    vehicle.gain = 1;
    vehicle.one_axle_gain = one_axle_gain;
    vehicle.imu.lowpass_hz = imu.lowpass_hz > 0 ? imu.lowpass_hz : no_lowpass_hz;
    vehicle.imu.lowpass_order = imu.lowpass_order;
    vehicle.imu.noise_mps2 = imu.noise_mps2;
    vehicle.imu.noise_radps = imu.noise_radps;
    vehicle.uncertainty.clear();
    return vehicle;
}

/// Returns what is known of a car: its parameters with the errors of the recipe, not its friction.
Vehicle
written_vehicle(const Vehicle& truth, const KnowledgeRecipe& knowledge, std::uint64_t seed) {
    Random random{seed};
    Vehicle vehicle = truth;
    auto& body = vehicle.half_car;
    body.friction_n.reset();
    const auto write = [&](const char* name, double& number, double sd) {
        number = written(random, number, sd);
        vehicle.uncertainty[name] = sd;
    };
    write("ms_kg", body.ms_kg, knowledge.ms_kg);
    write("mu_kg", body.mu_kg, knowledge.mu_kg);
    write("ks_n_per_m", body.ks_n_per_m, knowledge.ks_n_per_m);
    write("cs_ns_per_m", body.cs_ns_per_m, knowledge.cs_ns_per_m);
    write("kt_n_per_m", body.kt_n_per_m, knowledge.kt_n_per_m);
    write("is_kgm2", body.is_kgm2, knowledge.is_kgm2);
    if (vehicle.axles && knowledge.dynamic_index > 0) {
        write("dynamic_index", vehicle.axles->dynamic_index, knowledge.dynamic_index);
    }
    if (knowledge.gain > 0) {
        write("gain", vehicle.gain, knowledge.gain);
        vehicle.one_axle_gain = one_axle_gain * vehicle.gain;
    }
    return vehicle;
}

FleetCar made_car(const FleetScenario& recipe, std::size_t number, std::uint64_t seed) {
    const auto& plan = recipe.cars[number];
    Random random{seed_of({seed, draw_faults, number})};
    FleetCar car{.car = plan.car,
                 .imu = plan.imu,
                 .gnss = recipe.gnss,
                 .gnss_latency_s = 0,
                 .odometer_scale = 1,
                 .acc = plan.acc,
                 .gyro = plan.gyro,
                 .wheel_speed = plan.wheel_speed,
                 .truth = true_vehicle(plan.car, plan.imu),
                 .written = {}};
    car.written =
        written_vehicle(car.truth, recipe.knowledge, seed_of({seed, draw_knowledge, number}));
    car.imu.acc_bias_mps2 = three(random, recipe.spread.acc_bias_mps2);
    car.imu.gyro_bias_radps = three(random, recipe.spread.gyro_bias_radps);
    car.imu.tilt_rpy_deg = three(random, recipe.spread.tilt_deg);
    car.gnss_latency_s = random.uniform(recipe.gnss.latency_s.low, recipe.gnss.latency_s.high);
    car.odometer_scale = 1 + recipe.odometer.scale_sd * std::clamp(random.normal(), -3.0, 3.0);
    if (plan.gnss_rate_hz > 0) {
        car.gnss.rate_hz = plan.gnss_rate_hz;
    }
    return car;
}

/// Assigns cars in turn; a return trip is driven by the car of the outward trip.
std::size_t car_of_trip(const Fleet& fleet, std::size_t number) {
    const bool back = is_return(fleet.recipe.driving, fleet.seed, number);
    const auto turn = number / 2 + (number % 2 == 1 && !back ? 1 : 0);
    return turn % fleet.cars.size();
}

/// Spreads trips over the days of the recipe in their order, by daylight; whole milliseconds.
double start_utc_s(const Fleet& fleet, std::size_t number) {
    constexpr double day_s = 86400;
    constexpr double dawn_s = 6 * 3600.0;
    constexpr double dusk_s = 19 * 3600.0;
    const auto& driving = fleet.recipe.driving;
    Random random{seed_of({fleet.seed, draw_date, number / 2})};
    const double days =
        std::floor(static_cast<double>(driving.to_utc_s - driving.from_utc_s) / day_s) + 1;
    const double pairs = std::ceil(static_cast<double>(driving.trips) / 2);
    const double share =
        (static_cast<double>(number / 2) + random.uniform()) / std::max(1.0, pairs);
    const double day = std::floor(std::clamp(share, 0.0, 1 - 1e-9) * days);
    const double hour_s = random.uniform(dawn_s, (dawn_s + dusk_s) / 2) +
                          (number % 2 == 1 ? (dusk_s - dawn_s) / 2 : 0);
    return static_cast<double>(driving.from_utc_s) + day * day_s + whole_mm(hour_s);
}

TriaxialSamples samples_of(const std::vector<double>& t_s,
                           const std::vector<std::array<float, 3>>& readings) {
    TriaxialSamples samples{.t_s = t_s, .x = {}, .y = {}, .z = {}};
    for (const auto& [x, y, z] : readings) {
        samples.x.push_back(x);
        samples.y.push_back(y);
        samples.z.push_back(z);
    }
    return samples;
}

TripMeta meta_of(const Fleet& fleet, const FleetCar& car, std::size_t number) {
    TripMeta meta;
    meta.vehicle_id = car.written.name;
    meta.trip_id = fmt::format("{}-{:04}", car.written.name, number + 1);
    meta.t0_utc_s = start_utc_s(fleet, number);
    meta.frame = Frame::flu;
    meta.frame_stated = true;
    meta.gravity_included = true;
    if (fleet.recipe.gnss.latency_stated) {
        meta.gnss_latency_stated = true;
        meta.gnss_latency_s = whole_mm(car.gnss_latency_s);
    }
    if (const auto& axles = car.car.vehicle.axles; axles && car.gnss.antenna_ahead_m != 0) {
        meta.gnss_antenna_pos_m = {
            axles->cg_to_front_m - car.gnss.antenna_ahead_m, car.gnss.antenna_left_m, 0};
    }
    meta.other["source"] = "simulated";
    return meta;
}

} // namespace

Fleet make_fleet(FleetScenario recipe, const RoadNetwork& roads, std::uint64_t seed) {
    if (recipe.cars.empty()) {
        throw InputError{"the recipe has no car, expected at least one"};
    }
    Fleet fleet{.recipe = std::move(recipe), .seed = seed, .cars = {}, .map = {}};
    fleet.map = make_route_map(roads, fleet.recipe.driving, seed);
    for (std::size_t i = 0; i < fleet.recipe.cars.size(); ++i) {
        fleet.cars.push_back(made_car(fleet.recipe, i, seed));
    }
    return fleet;
}

TripLog simulate_trip(const Fleet& fleet,
                      const RoadNetwork& roads,
                      const LaneSource& lanes,
                      std::size_t number) {
    const auto& driving = fleet.recipe.driving;
    const auto& car = fleet.cars[car_of_trip(fleet, number)];
    const auto drawn = [&](Draw what) { return seed_of({fleet.seed, what, number}); };

    const auto route = route_of_trip(roads, fleet.map, driving, fleet.seed, number);
    const auto path = driven_path(roads, route, driving, drawn(draw_path));
    const auto motion = drive_along(path, roads, route, driving, drawn(draw_speed));

    TripLog trip;
    trip.meta = meta_of(fleet, car, number);
    if (car.acc || car.gyro) {
        const auto road = road_under(path, lanes, car.car.vehicle.half_car.l_m);
        const auto imu = simulate_imu(car.car, car.imu, road, motion, drawn(draw_imu));
        trip.acc = car.acc ? samples_of(imu.t_s, imu.acc_mps2) : TriaxialSamples{};
        trip.gyro = car.gyro ? samples_of(imu.t_s, imu.gyro_radps) : TriaxialSamples{};
    }
    if (car.wheel_speed) {
        trip.speed =
            wheel_speeds(motion, fleet.recipe.odometer, car.odometer_scale, drawn(draw_wheels));
    }
    trip.fixes = received_fixes(path, motion, car.gnss, car.gnss_latency_s, drawn(draw_gnss));
    return trip;
}

} // namespace macadam
