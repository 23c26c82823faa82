#pragma once

#include "estimator/common/trip.hpp"
#include "mapping/simulation/driven_path.hpp"
#include "mapping/simulation/fleet_scenario.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// What a satellite receiver in the car says, from its first fix on, with holes where it had none.
///
/// \param latency_s  the truth of a fix is this much older than its stamp.
std::vector<GnssFix> received_fixes(const DrivenPath& path,
                                    const Motion& motion,
                                    const GnssRecipe& gnss,
                                    double latency_s,
                                    std::uint64_t seed);

/// What the wheels say: speed of the centre of gravity times `scale`, with noise, in whole quanta.
SpeedSamples wheel_speeds(const Motion& motion,
                          const OdometerRecipe& odometer,
                          double scale,
                          std::uint64_t seed);

} // namespace macadam
