#pragma once

#include "storage/trips/log/trip_row.hpp"

#include <array>

namespace macadam {

/// Permutes the axes of accelerometer and gyro: axis i of the result is the given axis of the row,
/// 1 to 3, reversed if negative (TableMapping::axes).
TripRow in_vehicle_axes(TripRow row, const std::array<int, 3>& axes);

} // namespace macadam
