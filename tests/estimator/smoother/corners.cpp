#include "corners.hpp"

#include <algorithm>
#include <cmath>

namespace macadam::testing {
namespace {

/// Of a wheel: place in the car, suspension, and where it stands among the coordinates.
struct Wheel {
    double ahead_m, left_m, ks_n_per_m, cs_ns_per_m;
    std::size_t at, other; ///< coordinate of it, and of the other one on its axle
};

std::array<Wheel, 4> wheels_of(const Vehicle& vehicle) {
    const auto& half = vehicle.half_car;
    const double ahead_m = vehicle.axles ? vehicle.axles->cg_to_front_m : 0;
    const double behind_m = vehicle.axles ? vehicle.axles->wheelbase_m - ahead_m : 0;
    const double ratio = vehicle.axles ? vehicle.axles->rear_ratio : 1;
    const double front = 2 / (1 + ratio);
    const double rear = 2 * ratio / (1 + ratio);
    const double l = half.l_m;
    const double k = half.ks_n_per_m;
    const double c = half.cs_ns_per_m;
    return {Wheel{ahead_m, l, front * k, front * c, 3, 4},
            Wheel{ahead_m, -l, front * k, front * c, 4, 3},
            Wheel{-behind_m, l, rear * k, rear * c, 5, 6},
            Wheel{-behind_m, -l, rear * k, rear * c, 6, 5}};
}

/// How far a wheel is pressed toward the body (or how fast, of rates).
double stroke(const Wheel& wheel, const std::array<double, 7>& x) {
    return x[wheel.at] - (x[0] - wheel.ahead_m * x[1] + wheel.left_m * x[2]);
}

/// The same of the wheel on the other side.
double stroke_beyond(const Wheel& wheel, const std::array<double, 7>& x) {
    return x[wheel.other] - (x[0] - wheel.ahead_m * x[1] - wheel.left_m * x[2]);
}

double pitch_kgm2(const Vehicle& vehicle) {
    const auto& axles = *vehicle.axles;
    return axles.dynamic_index * vehicle.half_car.ms_kg * axles.cg_to_front_m *
           (axles.wheelbase_m - axles.cg_to_front_m);
}

Corners plus(Corners x, const Corners& slope, double h) {
    for (std::size_t i = 0; i < 7; ++i) {
        x.place[i] += h * slope.place[i];
        x.rate[i] += h * slope.rate[i];
    }
    return x;
}

} // namespace

std::array<double, 7>
accelerations(const Vehicle& vehicle, const Corners& x, const Tracks& road_m) {
    const auto& half = vehicle.half_car;
    std::array<double, 7> force{}; // and moments
    std::size_t track = 0;
    for (const auto& wheel : wheels_of(vehicle)) {
        const double bar_n =
            half.antiroll_n_per_m * (stroke(wheel, x.place) - stroke_beyond(wheel, x.place)) / 2;
        const double up_n = wheel.ks_n_per_m * stroke(wheel, x.place) +
                            wheel.cs_ns_per_m * stroke(wheel, x.rate) + bar_n;
        force[0] += up_n;
        force[1] -= wheel.ahead_m * up_n;
        force[2] += wheel.left_m * up_n;
        force[wheel.at] = half.kt_n_per_m * (road_m[track++] - x.place[wheel.at]) - up_n;
    }
    std::array<double, 7> acceleration{};
    acceleration[0] = force[0] / half.ms_kg;
    acceleration[1] = vehicle.axles ? force[1] / pitch_kgm2(vehicle) : 0;
    acceleration[2] = force[2] / (2 * half.is_kgm2);
    for (std::size_t i = 3; i < 7; ++i) {
        acceleration[i] = force[i] / half.mu_kg;
    }
    return acceleration;
}

double energy_j(const Vehicle& vehicle, const Corners& x) {
    const auto& half = vehicle.half_car;
    double twice = half.ms_kg * x.rate[0] * x.rate[0] +
                   pitch_kgm2(vehicle) * x.rate[1] * x.rate[1] +
                   2 * half.is_kgm2 * x.rate[2] * x.rate[2];
    for (const auto& wheel : wheels_of(vehicle)) {
        const double own = stroke(wheel, x.place);
        const double apart = (own - stroke_beyond(wheel, x.place)) / 2;
        twice += half.mu_kg * x.rate[wheel.at] * x.rate[wheel.at] +
                 half.kt_n_per_m * x.place[wheel.at] * x.place[wheel.at] +
                 wheel.ks_n_per_m * own * own + half.antiroll_n_per_m * apart * apart;
    }
    return twice / 2;
}

Corners corners_of(const States& x) {
    Corners corners;
    const auto part = [&](int rate) {
        const auto at = [&](int i) { return x[i + rate]; };
        return std::array<double, 7>{
            at(0), at(2), at(8), at(4) + at(10), at(4) - at(10), at(6) + at(12), at(6) - at(12)};
    };
    corners.place = part(0);
    corners.rate = part(1);
    return corners;
}

States states_of(const Corners& corners) {
    States x;
    const auto put = [&](const std::array<double, 7>& from, int rate) {
        x[0 + rate] = from[0];
        x[2 + rate] = from[1];
        x[4 + rate] = (from[3] + from[4]) / 2;
        x[6 + rate] = (from[5] + from[6]) / 2;
        x[8 + rate] = from[2];
        x[10 + rate] = (from[3] - from[4]) / 2;
        x[12 + rate] = (from[5] - from[6]) / 2;
    };
    put(corners.place, 0);
    put(corners.rate, 1);
    return x;
}

Corners ridden(const Vehicle& vehicle,
               const Corners& from,
               const std::function<Tracks(double part)>& road_m,
               double step_s,
               int substeps) {
    const double h = step_s / substeps;
    Corners x = from;
    for (int i = 0; i < substeps; ++i) {
        const auto slope = [&](const Corners& y, double part) {
            return Corners{y.rate, accelerations(vehicle, y, road_m((i + part) / substeps))};
        };
        const auto k1 = slope(x, 0);
        const auto k2 = slope(plus(x, k1, h / 2), 0.5);
        const auto k3 = slope(plus(x, k2, h / 2), 0.5);
        const auto k4 = slope(plus(x, k3, h), 1);
        x = plus(plus(plus(plus(x, k1, h / 6), k2, h / 3), k3, h / 3), k4, h / 6);
    }
    return x;
}

Vehicle lopsided_car() {
    return {.name = "lopsided",
            .one_axle_gain = {},
            .half_car = {.ms_kg = 1600,
                         .mu_kg = 45,
                         .ks_n_per_m = 30000,
                         .cs_ns_per_m = 2500,
                         .kt_n_per_m = 250000,
                         .is_kgm2 = 430,
                         .l_m = 0.78,
                         .antiroll_n_per_m = 8000},
            .axles = Axles{.wheelbase_m = 2.75,
                           .cg_to_front_m = 1.25,
                           .dynamic_index = 0.9,
                           .rear_ratio = 1.15},
            .imu = {.x_m = 0.5, .y_m = -0.3, .height_above_roll_axis_m = 0.4},
            .uncertainty = {}};
}

double elevation_at(std::span<const double> road_m, double step_m, double at_m) {
    const double place = std::clamp(at_m / step_m, 0.0, static_cast<double>(road_m.size()) - 1.0);
    const auto i = std::min(static_cast<std::size_t>(place), road_m.size() - 2);
    return std::lerp(road_m[i], road_m[i + 1], place - static_cast<double>(i));
}

Tracks under_wheels(const Vehicle& vehicle,
                    std::span<const double> left_m,
                    std::span<const double> right_m,
                    double step_m,
                    double travel_m) {
    const double ahead_m = vehicle.axles ? vehicle.axles->cg_to_front_m : 0;
    const double behind_m = vehicle.axles ? vehicle.axles->wheelbase_m - ahead_m : 0;
    return {elevation_at(left_m, step_m, travel_m + ahead_m),
            elevation_at(right_m, step_m, travel_m + ahead_m),
            elevation_at(left_m, step_m, travel_m - behind_m),
            elevation_at(right_m, step_m, travel_m - behind_m)};
}

std::vector<States> ride(const Vehicle& vehicle,
                         std::span<const double> left_m,
                         std::span<const double> right_m,
                         double road_step_m,
                         std::span<const double> travel_m,
                         double step_s,
                         int substeps) {
    Corners x;
    std::vector<States> states{states_of(x)};
    for (std::size_t k = 1; k < travel_m.size(); ++k) {
        const auto under = [&](double part) {
            return under_wheels(vehicle,
                                left_m,
                                right_m,
                                road_step_m,
                                std::lerp(travel_m[k - 1], travel_m[k], part));
        };
        x = ridden(vehicle, x, under, step_s, substeps);
        states.push_back(states_of(x));
    }
    return states;
}

} // namespace macadam::testing
