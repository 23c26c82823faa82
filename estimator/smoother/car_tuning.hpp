#pragma once

#include "estimator/smoother/joint_smoother.hpp"

namespace macadam {

/// A car as its own readings say it is.
struct TunedCar {
    Vehicle vehicle;       ///< its stated parameters moved by what was found
    double friction_n = 0; ///< of each suspension
    double friction_sd_n = 0;
    double colour = 0; ///< of the road on which it was tuned: RoadPrior's
    double iri_sd = 0; ///< relative, of every IRI of the car alike: what is left of it, together
};

/// Most probable parameters of a car, from a stretch of road that it drove itself.
///
/// Its two axles meet the same road one after the other, and its channels feel it in different
/// ways; a wrong damper, spring, tyre or mass makes them contradict each other. So the likelihood
/// of what was felt, over the smoother's own innovations, has a maximum near the true car. Dry
/// friction is looked for unless it is stated; other parameters are moved as far as their stated
/// uncertainty lets them (Gauss-Newton on the likelihood and that prior).
///
/// \param passage  some 1,000 to 5,000 samples; its `cars` are not used
TunedCar
tuned_car(const DriveRecord& passage, const Vehicle& vehicle, const SmootherConfig& config);

} // namespace macadam
