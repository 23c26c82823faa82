#pragma once

#include "estimator/motion/odometer.hpp"

namespace macadam {

/// The odometer of a trip; marks in `use` the speeds and the fixes (for their speed or place) that
/// entered it, and the reason for those that did not. `use` must have been made by `unused(trip)`.
///
/// \throws InputError  if the trip has neither speeds nor two fixes.
Odometer make_odometer(const TripLog& trip, const OdometerConfig& config, RowAudit& use);

} // namespace macadam
