#pragma once

#include "estimator/smoother/filter/road_smoother.hpp"
#include "estimator/vehicle/vehicle.hpp"

namespace macadam {

/// Returns the vehicle, first with its own dampers, then with increasingly harder ones that
/// represent dry friction.
std::vector<CarSteps> cars_with_friction(const Vehicle& vehicle, double step_s);

/// Selects the car for each sample so that its dampers dissipate as much over the strokes of the
/// four suspensions, within some 25 m to either side, as dampers and friction do together
/// (statistical linearisation: the viscous damping nearest in the mean square to friction_n *
/// sign(rate)).
///
/// \param roads_m     one or more draws of the road, each with the stations of the grid
/// \param friction_n  in each suspension, 0 or more
///
/// Source: J. B. Roberts, P. D. Spanos, "Random Vibration and Statistical Linearization" (1990),
/// section 5.2.
std::vector<std::uint8_t> damping_with_friction(const DriveRecord& drive,
                                                const Vehicle& vehicle,
                                                const RoadGrid& grid,
                                                std::span<const std::vector<Pair>> roads_m,
                                                double friction_n);

/// Returns what friction adds to the vehicle's own damping in the mean over the cars that
/// damping_with_friction() selected, relative to it.
double mean_added_damping(std::span<const std::uint8_t> which);

} // namespace macadam
