#include "estimator/smoother/car/drive_record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace macadam {

const CarSteps& car_at(const DriveRecord& drive, std::size_t sample) {
    return drive.cars[drive.which.empty() ? 0 : drive.which[sample]];
}

RoadGrid grid_under(std::span<const DriveRecord> drives, double cell_m) {
    constexpr auto far = std::numeric_limits<double>::infinity();
    double from_m = far;
    double to_m = -far;
    for (const auto& drive : drives) {
        const auto& car = drive.cars.front().car;
        from_m = std::min(from_m, drive.travel_m.front() + car.rear_m);
        to_m = std::max(to_m, drive.travel_m.back() + car.front_m);
    }
    const auto first = static_cast<std::ptrdiff_t>(std::floor((std::floor(from_m) - 1) / cell_m));
    const auto last = static_cast<std::ptrdiff_t>(std::floor(to_m / cell_m)) + 2;
    return {cell_m, first, static_cast<std::size_t>(last - first + 1)};
}

std::vector<CarState>
simulate_response(const DriveRecord& drive, const RoadGrid& grid, std::span<const Pair> road_m) {
    const auto at = [&](std::ptrdiff_t cell) -> const Pair& {
        return road_m[static_cast<std::size_t>(cell - grid.first_cell)];
    };
    CarState x = CarState::Zero();
    const auto& car = drive.cars.front().car;
    const double under_m = at(static_cast<std::ptrdiff_t>(
                                  std::floor((drive.travel_m.front() + car.rear_m) / grid.cell_m)))
                               .mean;
    x[0] = x[4] = x[6] = under_m; // heave and wheels
    std::vector<CarState> states_{x};
    states_.reserve(drive.travel_m.size());
    for (std::size_t k = 1; k < drive.travel_m.size(); ++k) {
        const auto& steps = car_at(drive, k);
        const double from_m = drive.travel_m[k - 1];
        const auto push = road_push(steps, from_m, drive.travel_m[k] - from_m, grid.cell_m);
        x = steps.phi * x;
        for (const auto& axle : push.axles) {
            for (std::size_t i = 0; i < axle.cells; ++i) {
                const Pair& road = at(axle.first + static_cast<std::ptrdiff_t>(i));
                for (std::size_t j = 0; j < LinearCar::heave_states; ++j) {
                    x[static_cast<int>(j)] += axle.heave[i][j] * road.mean;
                }
                for (std::size_t j = LinearCar::heave_states; j < LinearCar::states; ++j) {
                    x[static_cast<int>(j)] += axle.roll[i][j - LinearCar::heave_states] * road.half;
                }
            }
        }
        states_.push_back(x);
    }
    return states_;
}

} // namespace macadam
