#pragma once

#include "estimator/smoother/car/linear_car.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace macadam {

/// A linear car in steps of time, while the road under each wheel is a line in each of a few parts
/// of the step.
struct CarSteps {
    static constexpr std::size_t parts = 4;

    LinearCar car;
    double step_s;
    Eigen::Matrix<double, LinearCar::states, LinearCar::states> phi; ///< x[k+1] = phi x[k] + ...
    /// ... + sum of node[part] * inputs at the part's borders
    std::array<Eigen::Matrix<double, LinearCar::states, LinearCar::inputs>, parts + 1> node;
    Eigen::Matrix<double, LinearCar::states, pull_count> lean; ///< ... + lean * arm * pull
};

/// Exact while the inputs are lines between the borders of the parts (first-order hold), and pulls
/// are even over the step.
CarSteps car_steps(const LinearCar& car, double step_s);

/// What the elevations on a few stations of the road do to the car over one step: for each station
/// a column over the heave states, which its mean of the tracks moves, and one over the roll
/// states, which half the difference moves.
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

/// \param travel_m  of the centre of gravity at the step's begin
/// \param run_m     driven within the step, at most (max_cells - 3) * cell_m
/// \param cell_m    between stations; station i lies at i * cell_m
RoadPush road_push(const CarSteps& steps, double travel_m, double run_m, double cell_m);

} // namespace macadam
