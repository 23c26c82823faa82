#pragma once

#include "estimator/motion/odometer.hpp"

namespace macadam {

/// Builds the odometer of a trip. In `use`, marks the speeds and the fixes (for their speed or
/// position) that were used, and the reason for the others. `use` must have been made by
/// `unused(trip)`.
///
/// \throws InputError  if the trip has neither speeds nor two fixes.
Odometer make_odometer(const TripLog& trip, const OdometerConfig& config, RowAudit& use);

} // namespace macadam
