#include "estimator/smoother/filter/state_layout.hpp"

#include "estimator/smoother/filter/road_process.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr auto states = static_cast<std::size_t>(LinearCar::states);
constexpr auto heaves = static_cast<std::size_t>(LinearCar::heave_states);

/// Returns the states that affect the readings, directly or through others.
std::array<bool, states> live_states(const DriveRecord& drive) {
    const LinearCar& car = drive.cars.front().car;
    std::array<bool, states> live{};
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        for (std::size_t i = 0; i < states && !drive.felt[channel].empty(); ++i) {
            live[i] = live[i] || car.felt[channel][static_cast<int>(i)] != 0;
        }
    }
    for (std::size_t round = 0; round < states; ++round) {
        for (std::size_t i = 0; i < states; ++i) {
            for (std::size_t j = 0; live[i] && j < states; ++j) {
                live[j] = live[j] || car.a(static_cast<int>(i), static_cast<int>(j)) != 0;
            }
        }
    }
    return live;
}

/// Returns the number of stations held at once: those under the longest car and its travel in a
/// step, and the memory of the road.
std::size_t window_of(std::span<const DriveRecord> drives, double cell_m) {
    double longest_m = 0;
    for (const auto& drive : drives) {
        double step_m = 0;
        for (std::size_t k = 1; k < drive.travel_m.size(); ++k) {
            step_m = std::max(step_m, drive.travel_m[k] - drive.travel_m[k - 1]);
        }
        const auto& car = drive.cars.front().car;
        longest_m = std::max(longest_m, car.front_m - car.rear_m + step_m);
    }
    return std::max(static_cast<std::size_t>(std::ceil(longest_m / cell_m)) + 3, max_road_lags + 1);
}

StateLayout::Car
places_of(const DriveRecord& drive, const std::array<bool, states>& live, std::size_t first) {
    StateLayout::Car car{.states = {},
                         .first = first,
                         .zero = {},
                         .arm = {},
                         .heaves = 0,
                         .has_rear = drive.cars.front().car.front_m > 0};
    for (std::size_t i = 0; i < states; ++i) {
        if (live[i]) {
            car.states.push_back(i);
            car.heaves += i < heaves ? 1 : 0;
        }
    }
    std::size_t next = first + car.states.size();
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        car.zero[channel] = drive.felt[channel].empty() ? StateLayout::nowhere : next++;
    }
    const auto& lean = drive.cars.front().car.lean;
    for (std::size_t pull = 0; pull < pull_count; ++pull) {
        const bool leans = std::ranges::any_of(car.states, [&](std::size_t state) {
            return lean(static_cast<int>(state), static_cast<int>(pull)) != 0;
        });
        car.arm[pull] = drive.pull[pull].empty() || !leans ? StateLayout::nowhere : next++;
    }
    return car;
}

std::size_t places(const StateLayout::Car& car) {
    return car.states.size() +
           static_cast<std::size_t>(
               std::ranges::count_if(car.zero, [](auto at) { return at != StateLayout::nowhere; }) +
               std::ranges::count_if(car.arm, [](auto at) { return at != StateLayout::nowhere; }));
}

} // namespace

StateLayout layout_of(std::span<const DriveRecord> drives, const RoadGrid& grid) {
    StateLayout layout{.cars = {},
                       .side = {},
                       .sides = 0,
                       .road_at = 0,
                       .window = window_of(drives, grid.cell_m),
                       .first_cell = grid.first_cell,
                       .size = 0};
    for (const auto& drive : drives) {
        const auto live = live_states(drive);
        layout.cars.push_back(places_of(drive, live, layout.road_at));
        layout.road_at += places(layout.cars.back());
        for (std::size_t i = 0; i < states; ++i) {
            layout.side[i < heaves ? 0 : 1] = layout.side[i < heaves ? 0 : 1] || live[i];
        }
    }
    layout.sides = static_cast<std::size_t>(std::ranges::count(layout.side, true));
    layout.size = layout.road_at + layout.sides * layout.window;
    return layout;
}

} // namespace macadam
