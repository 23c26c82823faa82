#pragma once

#include "estimator/identification/road_profile.hpp"
#include "estimator/simulated_car.hpp"
#include "estimator/simulation/simulated_car.hpp"

namespace macadam::testing {

/// Two unlike tracks of ISO 8608 with waviness 2 at 0.05 m, whose first station is `from_m`.
RoadProfile rough_profile(double length_m, double from_m, unsigned seed);

/// The wheel paths of a simulated surface, at every station.
RoadProfile profile_of(const RoadSurface& surface);

/// A one-axle car over the profile from its first station at a constant speed, by Runge-Kutta over
/// the forces, without noise.
Stretch
one_axle_ride(const Vehicle& vehicle, const RoadProfile& profile, double speed_mps, double rate_hz);

/// A two-axle car of the simulation over the surface's wheel paths, noise 0.05 m/s2.
///
/// \param lowpass_hz  of the sensor; 0: none
Stretch two_axle_ride(const CarRecipe& car,
                      const RoadSurface& surface,
                      const Motion& motion,
                      double rate_hz,
                      double lowpass_hz = 0);

/// Between two speeds and back, once in `period_s`.
Motion swinging_motion(double slow_mps, double quick_mps, double period_s, double duration_s);

} // namespace macadam::testing
