#include "estimator/smoother/filter/measurement_order.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {

std::vector<SampleOrder> events_of(std::span<const DriveRecord> drives, double cell_m) {
    std::vector<SampleOrder> events;
    for (std::size_t car = 0; car < drives.size(); ++car) {
        const auto& drive = drives[car];
        for (std::size_t k = 0; k < drive.travel_m.size(); ++k) {
            const double front_m = drive.travel_m[k] + drive.cars.front().car.front_m;
            events.push_back(
                {car, k, front_m, static_cast<std::ptrdiff_t>(std::floor(front_m / cell_m)) + 1});
        }
    }
    std::ranges::stable_sort(events, {}, &SampleOrder::front_m);
    return events;
}

RoadPush
push_of(std::span<const DriveRecord> drives, const RoadGrid& grid, const SampleOrder& event) {
    if (event.sample == 0) {
        return {};
    }
    const auto& travel_m = drives[event.car].travel_m;
    const double from_m = travel_m[event.sample - 1];
    return road_push(car_at(drives[event.car], event.sample),
                     from_m,
                     travel_m[event.sample] - from_m,
                     grid.cell_m);
}

} // namespace macadam
