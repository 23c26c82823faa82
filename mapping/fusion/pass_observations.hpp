#pragma once

#include "mapping/fusion/fusion.hpp"
#include "mapping/fusion/mixed_model.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace macadam {

/// Removes the calibration of the car from a reading, which is linear in IRI.
double true_um(const FusionInput& input, double read_um);

/// Sorts passes by car, period, trip and occurrence; cars by their first trip, so that vehicle
/// numbers do not affect any sum.
std::vector<const FusionInput*> by_car(std::span<const FusionInput> passes);

/// Returns the calibrated readings.
Eigen::VectorXd values_of(const std::vector<const FusionInput*>& passes);

/// Rescales the stated sds to the level of the segment. An sd is mostly proportional to the
/// reading, and a pass must not gain weight by reading low.
Eigen::VectorXd stated_um(const std::vector<const FusionInput*>& passes, double level_um);

/// Sets the values of references to 0.
Eigen::VectorXd of_cars_alone(const std::vector<const FusionInput*>& passes,
                              Eigen::VectorXd values);

/// Stated sds in two parts: common to all cars, and of the car.
struct StatedParts {
    Eigen::VectorXd common; ///< 0 for references
    Eigen::VectorXd car;    ///< of a car that is not calibrated
};

StatedParts stated_parts(const std::vector<const FusionInput*>& passes,
                         const Eigen::VectorXd& stated,
                         double level_um,
                         const FusionConfig& config);

/// Returns the passes, sorted by car, as observations of the mixed model.
///
/// \param beside_car  sds that count as part of the car's error, in addition to its own.
FusionObservations observations_of(const std::vector<const FusionInput*>& passes,
                                   const Eigen::VectorXd& values,
                                   const Eigen::VectorXd& stated,
                                   const Eigen::VectorXd& of_car,
                                   const Eigen::VectorXd& beside_car,
                                   double level_um,
                                   const FusionConfig& config);

} // namespace macadam
