#pragma once

#include "estimator/smoother/filter/road_smoother.hpp"
#include "estimator/vehicle/vehicle.hpp"

namespace macadam {

/// The car with its dampers as they are and harder step by step, for what dry friction adds to
/// them. The first is the vehicle's own.
std::vector<CarSteps> cars_with_friction(const Vehicle& vehicle, double step_s);

/// Which of the cars holds at each sample, so that its dampers take as much out of the strokes of
/// the four suspensions, over some 25 m to either side, as dampers and friction do together
/// (statistical linearisation: the viscous damping nearest in the mean square to
/// friction_n * sign(rate)).
///
/// \param roads       one or more that could have been, each as many stations as the grid
/// \param friction_n  in each suspension, 0 or more
///
/// Source: J. B. Roberts, P. D. Spanos, "Random Vibration and Statistical Linearization" (1990),
/// section 5.2.
std::vector<std::uint8_t> damping_with_friction(const DriveRecord& passage,
                                                const Vehicle& vehicle,
                                                const RoadGrid& grid,
                                                std::span<const std::vector<Pair>> roads_m,
                                                double friction_n);

} // namespace macadam
