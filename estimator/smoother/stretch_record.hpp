#pragma once

#include "estimator/roughness/roughness_trace.hpp"
#include "estimator/smoother/car/drive_record.hpp"
#include "estimator/smoother/vibration/resonance.hpp"

namespace macadam {

/// Converts a whole stretch to a drive without cars: the sampled channels that the method uses,
/// with gain and centripetal acceleration removed, the known inputs to the body, and the variance
/// that the linear car does not explain. The line of out-of-round wheels and the resonance of the
/// sensor's mount are removed.
DriveRecord drive_of(const Stretch& stretch,
                     const Vehicle& vehicle,
                     const EstimatorConfig& config,
                     const Resonance& mount = {});

/// Returns samples [from, to) of a drive.
DriveRecord piece_of(const DriveRecord& whole, std::size_t from, std::size_t to);

/// Returns the vehicle, with the usual height of its sensor above the roll axis if it is not known.
Vehicle with_height(Vehicle vehicle);

} // namespace macadam
