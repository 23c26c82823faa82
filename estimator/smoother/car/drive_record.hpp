#pragma once

#include "estimator/smoother/car/discrete_car.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// What one car felt on its way over the road, on an even grid of time. Every series that is there
/// has as many values as travel_m.
struct DriveRecord {
    std::vector<CarSteps> cars;      ///< one, or as many as its damping takes values; same step_s
    std::vector<std::uint8_t> which; ///< of them holds up to each sample; empty: the first
    std::int64_t first_sample = 0;   ///< on the trip's own count, so that pieces of it draw alike
    std::vector<double> travel_m;    ///< of the centre of gravity, rising
    std::array<std::vector<double>, channel_count> felt; ///< m/s^2, rad/s; empty: not sampled
    /// Of what the linear car does not explain: sensor noise, and what the model leaves out.
    std::array<std::vector<double>, channel_count> variance;
    std::array<double, channel_count> drift{}; ///< of a channel's zero: its variance per second
    /// m/s^2, over the step up to each sample; empty: none, or not known.
    std::array<std::vector<double>, pull_count> pull;
};

/// The car up to a sample.
const CarSteps& car_at(const DriveRecord& passage, std::size_t sample);

/// Stations i * cell_m, i = first_cell and on; the road is a line between two of them.
struct RoadGrid {
    double cell_m = 0.25;
    std::ptrdiff_t first_cell = 0;
    std::size_t cells = 0;
};

/// The stations that the passages' wheels come over, from a whole metre on.
RoadGrid grid_under(std::span<const DriveRecord> passages, double cell_m);

/// A number for the mean of the tracks and one for half the difference, left minus right.
struct Pair {
    double mean = 0;
    double half = 0;
};

using CarState = Eigen::Matrix<double, LinearCar::states, 1>;

/// How the passage's car moves over a road on the grid, at every sample; it starts at rest, and
/// nothing pulls at it.
std::vector<CarState>
simulate_response(const DriveRecord& passage, const RoadGrid& grid, std::span<const Pair> road_m);

} // namespace macadam
