#pragma once

#include "estimator/smoother/car_steps.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// What one car felt on its way over the road, on an even grid of time. Every series that is there
/// has as many values as travel_m.
struct Passage {
    std::vector<CarSteps> cars;      ///< one, or as many as its damping takes values; same step_s
    std::vector<std::uint8_t> which; ///< of them holds up to each sample; empty: the first
    std::int64_t first_sample = 0;   ///< on the trip's own count, so that pieces of it draw alike
    std::vector<double> travel_m;    ///< of the centre of gravity, rising
    std::array<std::vector<double>, channel_count> felt; ///< m/s^2, rad/s; empty: not sampled
    /// Of what the linear car does not explain: sensor noise, and what the model leaves out.
    std::array<std::vector<double>, channel_count> variance;
    std::array<double, channel_count> drift{}; ///< of a channel's zero: its variance per second
};

/// The car up to a sample.
const CarSteps& car_at(const Passage& passage, std::size_t sample);

/// Stations i * cell_m, i = first_cell and on; the road is a line between two of them.
struct RoadGrid {
    double cell_m = 0.25;
    std::ptrdiff_t first_cell = 0;
    std::size_t cells = 0;
};

/// The stations that the passages' wheels come over, from a whole metre on.
RoadGrid grid_under(std::span<const Passage> passages, double cell_m);

/// How much the road changes from a station to the next, m^2: variance of the mean of both tracks,
/// of half their difference (left minus right), and the covariance of the two.
struct Increment {
    double mean, half, cross;
};

/// What is thought of a road before it is driven: mean and half difference wander from station to
/// station, and each forgets where it was over a length.
struct RoadPrior {
    std::vector<Increment> increments; ///< as many as the grid has stations
    double mean_length_m = 30;         ///< a corner at 190 m, where the golden car feels nothing
    double half_length_m = 4;          ///< long waves are common to both tracks
};

/// A number for the mean of the tracks and one for half the difference, left minus right.
struct Pair {
    double mean = 0;
    double half = 0;
};

struct SmoothedRoad {
    std::vector<Pair> profile_m;      ///< the mean of all roads that could have been, per station
    std::vector<Pair> perturbation_m; ///< added to it, or taken off: one of those roads
    std::vector<Pair> increment_m;    ///< of the profile, from the station before
    std::vector<Pair> perturbed_m;    ///< of the perturbation
    double log_likelihood = 0;        ///< of what was felt, but for a constant
    std::vector<double> innovation;   ///< over its sd, in the order in which it came
    std::vector<double> log_variance; ///< of the innovation
};

/// The road under linear cars: posterior mean, and a draw about it.
///
/// A Kalman filter over the cars' states, the zeros of their channels and the stations between the
/// axles, sample by sample in the order in which the front axles come along; then the disturbance
/// smoother. Rear axles meet the stations that front axles have left, so nothing is delayed and
/// nothing is approximated but the line between stations. Cost grows with the samples, and with the
/// square of the wheelbase in stations.
///
/// \param passages  at least one, each of two samples or more
/// \param seed      of the draw; the same for the same stations and samples, however they are cut
///
/// Source: J. Durbin, S. J. Koopman, "A simple and efficient simulation smoother for state space
/// time series analysis", Biometrika 89 (2002), pp. 603-615; P. de Jong, "Smoothing and
/// interpolation with the state-space model", JASA 84 (1989), pp. 1085-1088.
SmoothedRoad smooth_road(std::span<const Passage> passages,
                         const RoadGrid& grid,
                         const RoadPrior& prior,
                         std::uint64_t seed);

using CarState = Eigen::Matrix<double, LinearCar::states, 1>;

/// How the passage's car moves over a road on the grid, at every sample; it starts at rest.
std::vector<CarState>
ride_over(const Passage& passage, const RoadGrid& grid, std::span<const Pair> road_m);

} // namespace macadam
