#pragma once

#include "estimator/smoother/joint_smoother.hpp"
#include "estimator/smoother/vibration/car_from_vibration.hpp"

#include <optional>
#include <stop_token>

namespace macadam {

/// Car with parameters estimated from its own readings.
struct TunedCar {
    Vehicle vehicle;       ///< stated parameters, corrected by the estimate
    double friction_n = 0; ///< of each suspension
    double friction_sd_n = 0;
    double iri_sd = 0; ///< relative; remaining error common to every IRI of the car
    Resonance mount{}; ///< of the sensor; removed from its vertical acceleration
};

/// Estimates the most probable parameters of a car from a stretch of road that it drove.
///
/// Its two axles meet the same road one after the other, and its channels respond to it in
/// different ways; a wrong spring, tyre or dynamic index makes them contradict each other.
/// The likelihood of the readings, computed from the smoother's innovations, therefore has a
/// maximum near the true car. Dry friction is estimated unless it is stated, from the damping that
/// the trip's spectra show, else from the likelihood, and from what is usual; springs, tyres and
/// dynamic index are moved within their stated uncertainty, and with the dynamic index the sensor's
/// place along the car (Gauss-Newton on the likelihood and that prior). The uncertainty of all
/// others, of mass and damping above all, goes into iri_sd.
///
/// \param drive    some 1,000 to 5,000 samples; its `cars` are ignored
/// \param damping  as over these samples: of the strength of wheel hop in them
/// \throws InputError  after a stop request.
TunedCar tuned_car(const DriveRecord& drive,
                   const Vehicle& vehicle,
                   const SmootherConfig& smoother,
                   const std::optional<ShownDamping>& damping = {},
                   const std::stop_token& stop = {});

/// Returns the relative standard deviation of every IRI of a car that is due to uncertain
/// parameters: all of them, or only those that tuned_car() does not move.
double untuned_iri_sd(const Vehicle& vehicle, bool is_car_tuned);

} // namespace macadam
