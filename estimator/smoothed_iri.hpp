#pragma once

#include "estimator/iri_trace.hpp"
#include "estimator/smoother/car_tuning.hpp"

namespace macadam {

/// The piece of a stretch that a car is tuned by: a minute from the middle of it.
///
/// \returns  the car as it is to be taken over the whole trip. Friction is found; the stated
///           parameters are moved where vertical acceleration and pitch rate were both sampled,
///           for one of them alone says too little. The vehicle itself if the stretch is too short.
TunedCar car_in(const Stretch& stretch, const Vehicle& vehicle, const EstimatorConfig& config);

/// Both tracks of the road under one stretch by the joint smoother, in pieces of a kilometre or two
/// that overlap, so that memory does not grow with the stretch.
IriRun smoothed_iri(const Stretch& stretch, const TunedCar& car, const EstimatorConfig& config);

} // namespace macadam
