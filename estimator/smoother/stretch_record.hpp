#pragma once

#include "estimator/roughness/roughness_trace.hpp"
#include "estimator/smoother/car/drive_record.hpp"

namespace macadam {

/// A whole stretch as a passage, without cars: the channels that the method is to have of those
/// that were sampled, gain and the pull of bends taken off, what leans on the body, and the
/// variance of what the linear car does not explain. Where the wheels are not round their line is
/// taken out.
DriveRecord
passage_of(const Stretch& stretch, const Vehicle& vehicle, const EstimatorConfig& config);

/// Samples [from, to) of a passage.
DriveRecord piece_of(const DriveRecord& whole, std::size_t from, std::size_t to);

/// The vehicle, with the usual height of its sensor above the roll axis where none is known.
Vehicle with_height(Vehicle vehicle);

} // namespace macadam
