#pragma once

#include "estimator/common/trip.hpp"
#include "mapping/simulation/driven_path.hpp"
#include "mapping/simulation/fleet_scenario.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// Simulates the fixes of a satellite receiver in the car, from its first fix on, with outages.
///
/// \param latency_s  age of a fix at its time stamp.
std::vector<GnssFix> received_fixes(const DrivenPath& path,
                                    const Motion& motion,
                                    const GnssRecipe& gnss,
                                    double latency_s,
                                    std::uint64_t seed);

/// Simulates wheel speeds: speed of the centre of gravity times `scale`, with noise, quantised.
SpeedSamples wheel_speeds(const Motion& motion,
                          const OdometerRecipe& odometer,
                          double scale,
                          std::uint64_t seed);

} // namespace macadam
