#pragma once

#include "estimator/smoother/car/drive_record.hpp"

namespace macadam {

/// A sample of a car, in the order in which front axles come along.
struct SampleOrder {
    std::size_t car, sample;
    double front_m;           ///< where the front axle is
    std::ptrdiff_t last_cell; ///< that must be there: the one ahead of it
};

/// All samples of the passages, in that order.
std::vector<SampleOrder> events_of(std::span<const DriveRecord> passages, double cell_m);

/// What the stations do to the event's car on its way from the sample before; nothing on the first.
RoadPush
push_of(std::span<const DriveRecord> passages, const RoadGrid& grid, const SampleOrder& event);

} // namespace macadam
