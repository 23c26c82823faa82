#include "estimator/smoother/friction.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace macadam {
namespace {

constexpr double harder = 1.06;    // ratio of successive cars: the nearest is within 3 %
constexpr std::size_t cars = 24;   // up to 3.8 times the damping
constexpr double slip_mps = 0.005; // friction is partial below it
constexpr double reach_m = 25;
constexpr double min_rate2 = 1e-6; // (1 mm/s)^2: below it the suspension is at rest

/// Returns the compression rates of the four suspensions.
std::array<double, 4> stroke_rates(const CarState& x, const LinearCar& car, double l_m) {
    const double front = x[5] - x[1] + car.front_m * x[3];
    const double rear = x[7] - x[1] + car.rear_m * x[3];
    const double front_half = x[11] - l_m * x[9];
    const double rear_half = x[13] - l_m * x[9];
    return {front + front_half, front - front_half, rear + rear_half, rear - rear_half};
}

} // namespace

std::vector<CarSteps> cars_with_friction(const Vehicle& vehicle, double step_s) {
    std::vector<CarSteps> all;
    Vehicle harder_and_harder = vehicle;
    for (std::size_t i = 0; i < cars; ++i) {
        all.push_back(car_steps(linear_car(harder_and_harder), step_s));
        harder_and_harder.half_car.cs_ns_per_m *= harder;
    }
    return all;
}

std::vector<std::uint8_t> damping_with_friction(const DriveRecord& drive,
                                                const Vehicle& vehicle,
                                                const RoadGrid& grid,
                                                std::span<const std::vector<Pair>> roads_m,
                                                double friction_n) {
    const std::size_t n = drive.travel_m.size();
    const auto& car = drive.cars.front().car;
    std::vector<double> work(n + 1);  // sums of rate * direction, ...
    std::vector<double> power(n + 1); // ... and of rate^2
    for (const auto& road_m : roads_m) {
        const auto states = simulate_response(drive, grid, road_m);
        for (std::size_t k = 0; k < n; ++k) {
            for (const double rate : stroke_rates(states[k], car, vehicle.half_car.l_m)) {
                work[k + 1] += rate * rate / std::hypot(rate, slip_mps);
                power[k + 1] += rate * rate;
            }
        }
    }
    for (std::size_t k = 0; k < n; ++k) {
        work[k + 1] += work[k];
        power[k + 1] += power[k];
    }
    const double own = vehicle.half_car.cs_ns_per_m;
    std::vector<std::uint8_t> which(n);
    std::size_t from = 0;
    std::size_t to = 0;
    for (std::size_t k = 0; k < n; ++k) {
        while (drive.travel_m[k] - drive.travel_m[from] > reach_m) {
            ++from;
        }
        while (to + 1 < n && drive.travel_m[to + 1] - drive.travel_m[k] <= reach_m) {
            ++to;
        }
        const double seen = power[to + 1] - power[from];
        const double least = min_rate2 * 4 * static_cast<double>((to + 1 - from) * roads_m.size());
        const double added = friction_n * (work[to + 1] - work[from]) / std::max(seen, least);
        const double car_number = std::round(std::log1p(added / own) / std::log(harder));
        which[k] = static_cast<std::uint8_t>(std::min(car_number, static_cast<double>(cars - 1)));
    }
    return which;
}

double mean_added_damping(std::span<const std::uint8_t> which) {
    double sum = 0;
    for (const auto car : which) {
        sum += std::pow(harder, car) - 1;
    }
    return sum / static_cast<double>(which.size());
}

} // namespace macadam
