#pragma once

#include "estimator/smoother/car/drive_record.hpp"

#include <utility>

namespace macadam {

/// Layout of the filter's state vector for some drives: for each car, the states that affect one
/// of its readings, the zeros of the sampled channels and the lever arms of its pulls; and a window
/// of stations that moves along under the cars. States without effect on a reading are left out:
/// half the difference of the tracks with vertical acceleration only, pitch and rear wheels of a
/// car with one axle.
struct StateLayout {
    static constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

    struct Car {
        std::vector<std::size_t> states; ///< of LinearCar, in the order of their positions, ...
        std::size_t first;               ///< ... from this one on
        std::array<std::size_t, channel_count> zero; ///< or nowhere
        std::array<std::size_t, pull_count> arm;     ///< or nowhere
        std::size_t heaves; ///< number of leading states that the mean of the tracks drives
        bool has_rear;      ///< the wheels of the other axle have an effect

        /// Returns the ranks of the states that one side of the road drives.
        std::pair<std::size_t, std::size_t> of_side(std::size_t which) const {
            return which == 0 ? std::pair{std::size_t{0}, heaves}
                              : std::pair{heaves, states.size()};
        }
    };
    std::vector<Car> cars;
    std::array<bool, 2> side;  ///< sides of the road in the state: mean, half
    std::size_t sides;         ///< number of such sides
    std::size_t road_at;       ///< first position of the window
    std::size_t window;        ///< stations in it
    std::ptrdiff_t first_cell; ///< of the grid
    std::size_t size;          ///< of the full state

    /// Returns the position of a station's elevation while it is in the window; `which` is 0 for
    /// the mean, 1 for the half difference, and must be present.
    std::size_t place(std::ptrdiff_t cell, std::size_t which) const {
        return road_at + sides * (static_cast<std::size_t>(cell - first_cell) % window) +
               (which == 1 && side[0] ? 1 : 0);
    }
};

StateLayout layout_of(std::span<const DriveRecord> drives, const RoadGrid& grid);

} // namespace macadam
