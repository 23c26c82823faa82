#pragma once

#include "estimator/motion/stretch.hpp"
#include "estimator/vehicle/vehicle.hpp"

#include <functional>
#include <vector>

namespace macadam::testing {

using Elevation = std::function<double(double at_m)>;

/// What a half-car's body feels on a road, by fourth-order Runge-Kutta over the forces of each
/// spring and damper as they stand: nothing of it is the estimator's.
struct SimulatedRide {
    double step_s;
    std::vector<double> travel_m;
    std::vector<double> speed_mps;
    std::vector<double> vertical_mps2;
    std::vector<double> lateral_mps2; ///< height * theta'' (theta'' if the height is not known)
    std::vector<double> roll_radps{}; ///< positive as the left side rises
};

/// Drives `length_m` at `speed_mps(travel)`; `substeps` Runge-Kutta steps make one sample.
SimulatedRide drive(const Vehicle& vehicle,
                    const Elevation& left_m,
                    const Elevation& right_m,
                    double length_m,
                    const std::function<double(double)>& speed_mps,
                    double rate_hz,
                    int substeps);

/// The same at half the road, which the car's two axles meet one after the other: what the middle
/// of a car with two axles feels where its ends move on their own.
SimulatedRide drive_on_two_axles(const Vehicle& vehicle,
                                 const Elevation& road_m,
                                 double wheelbase_m,
                                 double length_m,
                                 double speed_mps,
                                 double rate_hz,
                                 int substeps);

/// The ride as the estimator takes it; channels that are not wanted stay empty.
Stretch stretch_of(const SimulatedRide& ride, bool vertical, bool lateral);

/// A road of ISO 8608 with waviness 2, class A times `roughness` squared in its spectrum, at 0.05
/// m.
std::vector<double> iso_road(double length_m, double roughness, unsigned seed);

/// Straight lines through elevations `step_m` apart.
Elevation along(const std::vector<double>& elevation_m, double step_m);

/// Mean of the E1926 stroke of `road`, of the piece from `from_m` to `to_m`.
double true_iri(const std::vector<double>& road_m, double step_m, double from_m, double to_m);

} // namespace macadam::testing
