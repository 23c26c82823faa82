#pragma once

#include "estimator/roughness/roughness_trace.hpp"
#include "estimator/smoother/car_tuning.hpp"

namespace macadam {

/// The piece of a stretch that a car is tuned by: a minute from the middle of it.
///
/// \returns  the car as it is to be taken over the whole trip. Friction is found; the stated
///           parameters are moved where vertical acceleration and pitch rate were both sampled,
///           for one of them alone says too little. The vehicle itself if the stretch is too short.
TunedCar car_in(const Stretch& stretch, const Vehicle& vehicle, const EstimatorConfig& config);

/// How a stretch is cut to be smoothed.
struct PieceConfig {
    double core_m = 1500;            ///< of a piece, ...
    std::size_t core_samples = 9000; ///< ... or so many, if the car is slow: some 25 MB
    double margin_m = 225;           ///< on both sides, where start-up and windows reach
};

/// Both tracks of the road under one stretch by the joint smoother, in pieces of a kilometre or two
/// that overlap, so that memory does not grow with the stretch.
IriRun smoothed_iri(const Stretch& stretch,
                    const TunedCar& car,
                    const EstimatorConfig& config,
                    const PieceConfig& pieces = {});

} // namespace macadam
