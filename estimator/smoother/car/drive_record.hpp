#pragma once

#include "estimator/smoother/car/discrete_car.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// Sensor record of one car's drive over the road, on an even grid of time. Every series that is
/// present has as many values as travel_m.
struct DriveRecord {
    std::vector<CarSteps> cars;      ///< one, or one per damping value; same step_s
    std::vector<std::uint8_t> which; ///< index of the car up to each sample; empty: the first
    std::int64_t first_sample = 0;   ///< since the start of the trip, for equal draws in pieces
    std::vector<double> travel_m;    ///< of the centre of gravity, increasing
    std::array<std::vector<double>, channel_count> felt; ///< m/s^2, rad/s; empty: not sampled
    /// Variance of the part that the linear car does not explain: sensor noise and model error.
    std::array<std::vector<double>, channel_count> variance;
    std::array<double, channel_count> drift{}; ///< variance per second of a channel's zero drift
    /// m/s^2, over the step up to each sample; empty: none, or not known.
    std::array<std::vector<double>, pull_count> pull;
};

/// Returns the car that applies up to a sample.
const CarSteps& car_at(const DriveRecord& drive, std::size_t sample);

/// Grid of stations i * cell_m, i >= first_cell; the road is linear between two stations.
struct RoadGrid {
    double cell_m = 0.25;
    std::ptrdiff_t first_cell = 0;
    std::size_t cells = 0;
};

/// Returns the stations that the wheels of the drives cross, starting at a whole metre.
RoadGrid grid_under(std::span<const DriveRecord> drives, double cell_m);

/// Values for the mean of the tracks and for half the difference, left minus right.
struct Pair {
    double mean = 0;
    double half = 0;
};

using CarState = Eigen::Matrix<double, LinearCar::states, 1>;

/// Simulates the drive's car over a road on the grid and returns its state at every sample. It
/// starts at rest and without pulls.
std::vector<CarState>
simulate_response(const DriveRecord& drive, const RoadGrid& grid, std::span<const Pair> road_m);

} // namespace macadam
