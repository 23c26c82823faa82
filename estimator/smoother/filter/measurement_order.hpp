#pragma once

#include "estimator/smoother/car/drive_record.hpp"

namespace macadam {

/// One sample of one car, for processing in the order of front axle positions.
struct SampleOrder {
    std::size_t car, sample;
    double front_m;           ///< position of the front axle
    std::ptrdiff_t last_cell; ///< last station required: the one ahead of the axle
};

/// Returns all samples of the drives, ordered by front axle position.
std::vector<SampleOrder> events_of(std::span<const DriveRecord> drives, double cell_m);

/// Returns the effect of the stations on the event's car since the previous sample; empty for the
/// first.
RoadPush
push_of(std::span<const DriveRecord> drives, const RoadGrid& grid, const SampleOrder& event);

} // namespace macadam
