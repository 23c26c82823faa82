#pragma once

#include "estimator/smoother/passage.hpp"

namespace macadam {

/// A sample of a car, in the order in which front axles come along.
struct Event {
    std::size_t car, sample;
    double front_m;           ///< where the front axle is
    std::ptrdiff_t last_cell; ///< that must be there: the one ahead of it
};

/// All samples of the passages, in that order.
std::vector<Event> events_of(std::span<const Passage> passages, double cell_m);

/// What the stations do to the event's car on its way from the sample before; nothing on the first.
RoadPush push_of(std::span<const Passage> passages, const RoadGrid& grid, const Event& event);

} // namespace macadam
