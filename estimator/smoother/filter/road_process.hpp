#pragma once

#include "estimator/smoother/filter/road_smoother.hpp"

#include <algorithm>

namespace macadam {

/// Maximum order of the road's autoregression: earlier stations on which a station depends.
inline constexpr std::size_t max_road_lags = 13;

/// Linear process of one side of the road: elevation = sum of lags[i] * the elevation i + 1
/// stations before + an increment of the prior.
class RoadProcess {
public:
    /// \param keep     weight of the previous elevation
    /// \param changes  RoadPrior::change_weights, at most max_road_lags - 1
    RoadProcess(double keep, const std::vector<double>& changes);

    /// Returns the weights for the station of this number, the nearest station first. Changes
    /// before the first station are not known.
    std::span<const double> lags(std::size_t station) const {
        return by_known_[std::min(station, by_known_.size() - 1)];
    }

private:
    std::vector<std::vector<double>> by_known_;
};

/// Returns the processes of the mean and of half the difference.
std::array<RoadProcess, 2> road_processes(const RoadPrior& prior, double cell_m);

/// Returns the increment of the first station, where the process is stationary.
Increment first_increment(const RoadPrior& prior, const RoadGrid& grid);

/// Scales a pair of standard normal numbers to the increments of a station.
Pair drawn_increment(const Increment& q, double one, double two);

/// Computes elevations from increments.
std::vector<Pair> profile_of(std::span<const Pair> increments_m,
                             const std::array<RoadProcess, 2>& processes);

} // namespace macadam
