#pragma once

#include "mapping/matching/lattice/observations.hpp"
#include "mapping/matching/placement/path_geometry.hpp"

#include <optional>
#include <vector>

namespace macadam {

/// A moment of a trip on a path, and what was measured then.
struct Epoch {
    double t_s;
    double travel_m;
    double speed_mps;
    bool measured; ///< the travel since the epoch before is the odometer's, not drawn from fixes
    std::optional<PointEn> fix;
    double fix_sd_m;                ///< of the receiver's slow error, per axis
    std::optional<double> gyro_rad; ///< mean turn so far, over the travel around the epoch
    double heading_variance = 0;    ///< that the gyro gained since the epoch before, rad^2
};

/// Where on the rounded line, in its driven length, the car was at an epoch.
struct PathPosition {
    double driven_m;
    double sd_m;
};

struct PlaceModel {
    double latency_sd_s;        ///< of what is left of the receiver's latency
    double scale_sd;            ///< of the travel
    double heading_half_m = 10; ///< Epoch::gyro_rad is a mean over so much travel before and after
};

/// The places of a trip along its path, given all its measurements.
///
/// An extended Kalman filter over the epochs, smoothed backward, run anew a few times about its own
/// result. Its state: the lead (driven length less travel), the odometer's scale, how far right of
/// the map's line the car keeps on two-way roads and on oneway ones, the receiver's latency, its
/// slow error (first-order Gauss-Markov, east and north), and where the gyro's zero points.
///
///     lead'    = lead + scale * travelled - lane * turned          (the outer lane is longer)
///     fix      = place(travel + lead) + lane * right - latency * speed * ahead + slow error
///     heading  = gyro + zero
///
/// \param nominal_m  per epoch, about where on the driven line it was. \returns as many.
///
/// Source: G. J. Bierman, "Fixed interval smoothing with discrete measurements", International
/// Journal of Control 18 (1973), pp. 65-75 (the modified Bryson-Frazier form: no inverses).
std::vector<PathPosition> smoothed_places(const SmoothedPath& line,
                                          const std::vector<Epoch>& epochs,
                                          std::vector<double> nominal_m,
                                          const PlaceModel& model);

} // namespace macadam
