#pragma once

#include "estimator/smoother/car/linear_car.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace macadam {

/// Linear car in discrete time; within a step, the road under each wheel is linear in each of a few
/// parts.
struct CarSteps {
    static constexpr std::size_t parts = 4;

    LinearCar car;
    double step_s;
    Eigen::Matrix<double, LinearCar::states, LinearCar::states> phi; ///< x[k+1] = phi x[k] + ...
    /// ... + sum of node[part] * inputs at the part's borders
    std::array<Eigen::Matrix<double, LinearCar::states, LinearCar::inputs>, parts + 1> node;
    Eigen::Matrix<double, LinearCar::states, pull_count> lean; ///< ... + lean * arm * pull
};

/// Discretises a car. The result is exact if the inputs are linear between the borders of the parts
/// (first-order hold) and pulls are constant over the step.
CarSteps car_steps(const LinearCar& car, double step_s);

/// Effect of the elevations at a few stations on the car over one step: each station has a column
/// over the heave states, driven by the mean of the tracks, and a column over the roll states,
/// driven by half the difference.
struct RoadPush {
    static constexpr std::size_t max_cells = 12;

    /// Stations first, first + 1, ... under one axle.
    struct Axle {
        std::ptrdiff_t first = 0;
        std::size_t cells = 0;
        std::array<std::array<double, LinearCar::heave_states>, max_cells> heave{};
        std::array<std::array<double, LinearCar::roll_states>, max_cells> roll{};
    };
    std::array<Axle, 2> axles; ///< front, rear
};

/// \param travel_m  of the centre of gravity at the beginning of the step
/// \param run_m     travel within the step, at most (max_cells - 3) * cell_m
/// \param cell_m    station spacing; station i lies at i * cell_m
RoadPush road_push(const CarSteps& steps, double travel_m, double run_m, double cell_m);

} // namespace macadam
