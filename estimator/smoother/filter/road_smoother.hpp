#pragma once

#include "estimator/smoother/car/drive_record.hpp"

namespace macadam {

/// Covariance of the change of the road between two stations, m^2: variance of the mean of both
/// tracks, of half their difference (left minus right), and the covariance of the two.
struct Increment {
    double mean, half, cross;
};

/// Prior of a road: mean and half difference follow a random walk from station to station, each
/// with a correlation length.
struct RoadPrior {
    std::vector<Increment> increments; ///< one per station of the grid
    /// Autoregression of the changes of the mean: weights of the changes at the stations before,
    /// nearest first; empty: a random walk (waviness 2). Half the difference remains a random walk.
    std::vector<double> change_weights{};
    double mean_length_m = 30; ///< corner at 190 m, where the golden car has no response
    double half_length_m = 4;  ///< long waves are common to both tracks
};

/// Residuals of a channel's readings over their variance, per sample: squares of the most probable
/// noise (`seen`), and of one draw about it (`open`).
struct Residual {
    std::vector<float> seen, open;
};

struct SmoothedRoad {
    std::vector<Pair> profile_m;      ///< posterior mean, per station
    std::vector<Pair> perturbation_m; ///< add or subtract: a draw from the posterior
    std::vector<Pair> increment_m;    ///< of the profile, as the prior's `increments`
    std::vector<Pair> perturbed_m;    ///< increments of the perturbation
    double log_likelihood = 0;        ///< of the readings, up to a constant
    std::vector<double> innovation;   ///< over its sd, in the order of processing
    std::vector<double> log_variance; ///< of the innovation
    std::vector<std::array<Residual, channel_count>> residual; ///< per drive
};

/// Update of the filter by one reading, as the backward pass needs it.
struct Update {
    double innovation; ///< of the estimate, over its variance, ...
    double error;      ///< ... and of the drawn error
    double noise;      ///< drawn noise
};

/// Work memory of a smoother, reused in the next round.
struct SmootherMemory {
    std::vector<Update> updates;
    std::vector<double> gains; ///< of the updates, one full state each
};

/// Estimates the road under linear cars: posterior mean, and a draw about it.
///
/// A Kalman filter over the cars' states, the zeros of their channels, the arms of their pulls and
/// the stations between the axles (StateLayout) processes the samples in the order of the front
/// axles; the disturbance smoother follows. Rear axles meet the stations that front axles have
/// left, so no delay is needed, and the only approximation is the straight line between stations.
/// The cost is proportional to the samples and to the square of the number of stations in the
/// wheelbase. For a side of the road that affects no reading, the profile is 0 and the perturbation
/// a draw of the prior.
///
/// \param drives  at least one, each of two samples or more
/// \param seed      of the draw; the same for the same stations and samples, however they are cut
///
/// Source: J. Durbin, S. J. Koopman, "A simple and efficient simulation smoother for state space
/// time series analysis", Biometrika 89 (2002), pp. 603-615; P. de Jong, "Smoothing and
/// interpolation with the state-space model", JASA 84 (1989), pp. 1085-1088.
SmoothedRoad smooth_road(std::span<const DriveRecord> drives,
                         const RoadGrid& grid,
                         const RoadPrior& prior,
                         std::uint64_t seed,
                         SmootherMemory& memory);

} // namespace macadam
