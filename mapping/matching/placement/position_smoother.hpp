#pragma once

#include "mapping/matching/lattice/observations.hpp"
#include "mapping/matching/placement/path_geometry.hpp"

#include <optional>
#include <vector>

namespace macadam {

/// A time on a path with its measurements.
struct Epoch {
    double t_s;
    double travel_m;
    double speed_mps;
    bool measured; ///< travel since the previous epoch is from the odometer, not from fixes
    std::optional<PointEn> fix;
    double fix_sd_m;                ///< of the receiver's slow error, per axis
    std::optional<double> gyro_rad; ///< mean cumulative turn over the travel around the epoch
    double heading_variance = 0;    ///< gained by the gyro since the previous epoch, rad^2
};

/// Position of the car at an epoch, in driven length along the rounded line.
struct PathPosition {
    double driven_m;
    double sd_m;
};

struct PositionModel {
    double latency_sd_s;        ///< of the uncorrected receiver latency
    double scale_sd;            ///< of the travel
    double heading_half_m = 10; ///< Epoch::gyro_rad averages over this travel before and after
};

/// Estimates the positions of a trip along its path from all its measurements.
///
/// An extended Kalman filter over the epochs, smoothed backward and iterated a few times about its
/// own result. The state contains the lead (driven length minus travel), the odometer's scale, the
/// car's offset to the right of the map's line on two-way and on oneway roads, the receiver's
/// latency, its slow error (first-order Gauss-Markov, east and north), and the gyro's zero
/// direction.
///     lead'    = lead + scale * travelled - lane * turned          (the outer lane is longer)
///     fix      = place(travel + lead) + lane * right - latency * speed * ahead + slow error
///     heading  = gyro + zero
///
/// \param nominal_m  approximate driven length at each epoch. \returns one position per epoch.
///
/// Source: G. J. Bierman, "Fixed interval smoothing with discrete measurements", International
/// Journal of Control 18 (1973), pp. 65-75 (the modified Bryson-Frazier form: no inverses).
std::vector<PathPosition> smoothed_places(const SmoothedPath& line,
                                          const std::vector<Epoch>& epochs,
                                          std::vector<double> nominal_m,
                                          const PositionModel& model);

} // namespace macadam
