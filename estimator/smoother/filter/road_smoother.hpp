#pragma once

#include "estimator/smoother/car/drive_record.hpp"

namespace macadam {

/// How much the road changes from a station to the next, m^2: variance of the mean of both tracks,
/// of half their difference (left minus right), and the covariance of the two.
struct Increment {
    double mean, half, cross;
};

/// What is thought of a road before it is driven: mean and half difference wander from station to
/// station, and each forgets where it was over a length.
struct RoadPrior {
    std::vector<Increment> increments; ///< as many as the grid has stations
    /// How much of a station's change goes on to the next, in (-1, 1): above 0 the spectrum of
    /// elevation falls faster than that of a random walk (waviness above 2), below 0 slower. Of the
    /// mean; half the difference keeps to a random walk.
    double colour = 0;
    double mean_length_m = 30; ///< a corner at 190 m, where the golden car feels nothing
    double half_length_m = 4;  ///< long waves are common to both tracks
};

/// What is left of a channel's readings, over their variance, per sample: squares of the most
/// probable noise, and of one draw about it.
struct Residual {
    std::vector<float> seen, open;
};

struct SmoothedRoad {
    std::vector<Pair> profile_m;      ///< the mean of all roads that could have been, per station
    std::vector<Pair> perturbation_m; ///< added to it, or taken off: one of those roads
    std::vector<Pair> increment_m;    ///< of the profile: what the prior's `increments` are of
    std::vector<Pair> perturbed_m;    ///< of the perturbation
    double log_likelihood = 0;        ///< of what was felt, but for a constant
    std::vector<double> innovation;   ///< over its sd, in the order in which it came
    std::vector<double> log_variance; ///< of the innovation
    std::vector<std::array<Residual, channel_count>> residual; ///< of each passage
};

/// A channel's reading taken in, as the way back needs it.
struct Update {
    double innovation; ///< of the estimate over its variance, ...
    double error;      ///< ... and of the drawn error
    double noise;      ///< that was drawn
};

/// Memory of a smoother, for the next round to use again.
struct SmootherMemory {
    std::vector<Update> updates;
    std::vector<double> gains; ///< of the updates, a whole state each
};

/// The road under linear cars: posterior mean, and a draw about it.
///
/// A Kalman filter over the cars' states, the zeros of their channels, the arms of their pulls and
/// the stations between the axles (StateLayout), sample by sample in the order in which the front
/// axles come along; then the disturbance smoother. Rear axles meet the stations that front axles
/// have left, so nothing is delayed and nothing is approximated but the line between stations. Cost
/// grows with the samples, and with the square of the wheelbase in stations. Of a side of the road
/// that nothing felt depends on, the profile is 0 and the perturbation a draw of the prior.
///
/// \param passages  at least one, each of two samples or more
/// \param seed      of the draw; the same for the same stations and samples, however they are cut
///
/// Source: J. Durbin, S. J. Koopman, "A simple and efficient simulation smoother for state space
/// time series analysis", Biometrika 89 (2002), pp. 603-615; P. de Jong, "Smoothing and
/// interpolation with the state-space model", JASA 84 (1989), pp. 1085-1088.
SmoothedRoad smooth_road(std::span<const DriveRecord> passages,
                         const RoadGrid& grid,
                         const RoadPrior& prior,
                         std::uint64_t seed,
                         SmootherMemory& memory);

} // namespace macadam
