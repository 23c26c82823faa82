#pragma once

#include "estimator/smoother/car/drive_record.hpp"

#include <utility>

namespace macadam {

/// Which numbers the filter of some passages has to follow, and their places in its state: of each
/// car the states that anything it felt depends on, the zeros of the channels that were felt and
/// the lever arms of its pulls, and a window of stations that goes along under the cars. What
/// nothing felt depends on is left out: half the difference of the tracks where there is only a
/// vertical acceleration, pitch and rear wheels of a car with one axle.
struct StateLayout {
    static constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

    struct Car {
        std::vector<std::size_t> states; ///< of LinearCar, in the order of their places, ...
        std::size_t first;               ///< ... from this one on
        std::array<std::size_t, channel_count> zero; ///< or nowhere
        std::array<std::size_t, pull_count> arm;     ///< or nowhere
        std::size_t heaves; ///< how many of the states, the first, the mean of the tracks moves
        bool has_rear;      ///< wheels on the other axle count

        /// Ranks of the states that one side of the road moves.
        std::pair<std::size_t, std::size_t> of_side(std::size_t which) const {
            return which == 0 ? std::pair{std::size_t{0}, heaves}
                              : std::pair{heaves, states.size()};
        }
    };
    std::vector<Car> cars;
    std::array<bool, 2> side;  ///< of the road that is there: mean, half
    std::size_t sides;         ///< how many of them
    std::size_t road_at;       ///< first place of the window
    std::size_t window;        ///< stations in it
    std::ptrdiff_t first_cell; ///< of the grid
    std::size_t size;          ///< of the whole state

    /// Where the elevation of a station is while it is in the window; `which` is 0 for the mean, 1
    /// for the half difference, and has to be there.
    std::size_t place(std::ptrdiff_t cell, std::size_t which) const {
        return road_at + sides * (static_cast<std::size_t>(cell - first_cell) % window) +
               (which == 1 && side[0] ? 1 : 0);
    }
};

StateLayout layout_of(std::span<const DriveRecord> passages, const RoadGrid& grid);

} // namespace macadam
