#include "simulated_car.hpp"

#include "estimator/iri/iri.hpp"

#include <array>
#include <cmath>
#include <random>

namespace macadam::testing {
namespace {

/// Heights and speeds of the body's two sides' centre, its roll (right side up) and both wheels.
struct State {
    std::array<double, 4> at{}; // body, roll, left wheel, right wheel
    std::array<double, 4> rate{};
};

State plus(const State& x, const State& slope, double h) {
    State y = x;
    for (std::size_t i = 0; i < 4; ++i) {
        y.at[i] += h * slope.at[i];
        y.rate[i] += h * slope.rate[i];
    }
    return y;
}

State slope_of(const State& x, const HalfCar& car, double left_m, double right_m) {
    const auto& [body, roll, wheel_l, wheel_r] = x.at;
    const auto& [body_v, roll_v, wheel_lv, wheel_rv] = x.rate;
    const double force_l = car.ks_n_per_m * (body - car.l_m * roll - wheel_l) +
                           car.cs_ns_per_m * (body_v - car.l_m * roll_v - wheel_lv);
    const double force_r = car.ks_n_per_m * (body + car.l_m * roll - wheel_r) +
                           car.cs_ns_per_m * (body_v + car.l_m * roll_v - wheel_rv);
    return {.at = x.rate,
            .rate = {-2 * (force_l + force_r) / car.ms_kg,
                     car.l_m * (force_l - force_r) / car.is_kgm2,
                     (force_l - car.kt_n_per_m * (wheel_l - left_m)) / car.mu_kg,
                     (force_r - car.kt_n_per_m * (wheel_r - right_m)) / car.mu_kg}};
}

} // namespace

SimulatedRide drive(const Vehicle& vehicle,
                    const Elevation& left_m,
                    const Elevation& right_m,
                    double length_m,
                    const std::function<double(double)>& speed_mps,
                    double rate_hz,
                    int substeps) {
    const auto& car = vehicle.half_car;
    const double height_m = vehicle.imu.height_above_roll_axis_m;
    const double arm_m = height_m > 0 ? height_m : 1;
    const double h = 1 / rate_hz / substeps;
    SimulatedRide ride{1 / rate_hz, {}, {}, {}, {}, {}};
    State x{};
    const double datum_m = (left_m(0) + right_m(0)) / 2;
    double travel_m = 0;
    for (int step = 0; travel_m < length_m; ++step) {
        const double v = speed_mps(travel_m);
        const auto slope = [&](const State& y, double at_m) {
            return slope_of(y, car, left_m(at_m) - datum_m, right_m(at_m) - datum_m);
        };
        const auto k1 = slope(x, travel_m);
        if (step % substeps == 0) {
            ride.travel_m.push_back(travel_m);
            ride.speed_mps.push_back(v);
            ride.vertical_mps2.push_back(vehicle.gain * k1.rate[0]);
            ride.lateral_mps2.push_back(vehicle.gain * arm_m * k1.rate[1]);
            ride.roll_radps.push_back(-k1.at[1]);
        }
        const auto k2 = slope(plus(x, k1, h / 2), travel_m + v * h / 2);
        const auto k3 = slope(plus(x, k2, h / 2), travel_m + v * h / 2);
        const auto k4 = slope(plus(x, k3, h), travel_m + v * h);
        x = plus(plus(plus(plus(x, k1, h / 6), k2, h / 3), k3, h / 3), k4, h / 6);
        travel_m += v * h;
    }
    return ride;
}

SimulatedRide drive_on_two_axles(const Vehicle& vehicle,
                                 const Elevation& road_m,
                                 double wheelbase_m,
                                 double length_m,
                                 double speed_mps,
                                 double rate_hz,
                                 int substeps) {
    // The model is linear: the mean of what two ends feel is what one end feels on the mean road.
    const auto mean = [=](double at_m) {
        return (road_m(at_m + wheelbase_m / 2) + road_m(at_m - wheelbase_m / 2)) / 2;
    };
    return drive(
        vehicle, mean, mean, length_m, [=](double) { return speed_mps; }, rate_hz, substeps);
}

Stretch stretch_of(const SimulatedRide& ride, bool vertical, bool lateral) {
    const auto floats = [](const std::vector<double>& values, bool wanted) {
        return wanted ? std::vector<float>(values.begin(), values.end()) : std::vector<float>{};
    };
    return {.start_s = 0,
            .step_s = ride.step_s,
            .vertical_mps2 = floats(ride.vertical_mps2, vertical),
            .lateral_mps2 = floats(ride.lateral_mps2, lateral),
            .roll_radps = {},
            .pitch_radps = {},
            .yaw_radps = {},
            .speed_mps = floats(ride.speed_mps, true),
            .travel_m = ride.travel_m};
}

std::vector<double> iso_road(double length_m, double roughness, unsigned seed) {
    // One-sided slope density of class A's mean, 4 pi^2 0.1^2 16e-6 m: white at 0.05 m.
    constexpr double density_m = 6.317e-6;
    std::mt19937 random{seed};
    std::normal_distribution<double> rise_m{0, roughness * std::sqrt(density_m / 2 * 0.05)};
    std::vector<double> road_m(static_cast<std::size_t>(length_m / 0.05) + 1);
    double height_m = 0;
    for (double& z : road_m) {
        z = height_m += rise_m(random);
    }
    return road_m;
}

Elevation along(const std::vector<double>& elevation_m, double step_m) {
    return [elevation_m, step_m](double at_m) {
        const double place = std::max(0.0, at_m / step_m);
        const auto i = std::min(static_cast<std::size_t>(place), elevation_m.size() - 2);
        return std::lerp(
            elevation_m[i], elevation_m[i + 1], std::min(1.0, place - static_cast<double>(i)));
    };
}

double true_iri(const std::vector<double>& road_m, double step_m, double from_m, double to_m) {
    const auto stroke = rectified_stroke_mm_per_m(road_m, step_m);
    const auto first = static_cast<std::size_t>(from_m / step_m + 0.5);
    const auto last = static_cast<std::size_t>(to_m / step_m + 0.5);
    double sum = 0;
    for (std::size_t i = first; i < last; ++i) {
        sum += static_cast<double>(stroke[i]);
    }
    return sum / static_cast<double>(last - first);
}

} // namespace macadam::testing
