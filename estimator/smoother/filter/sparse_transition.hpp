#pragma once

#include "estimator/smoother/filter/measurement_order.hpp"
#include "estimator/smoother/filter/state_layout.hpp"

namespace macadam {

/// Sparse step of the states of a car that one side of the road drives: each new state as a
/// weighted sum of the same old values (states, stations, the arm of a pull).
struct SparseTransition {
    static constexpr auto states = static_cast<std::size_t>(LinearCar::states);
    static constexpr std::size_t max_terms = states + 2 * RoadPush::max_cells + 1;

    std::size_t terms = 0;
    std::array<std::size_t, max_terms> place;                 ///< position in the filter's state
    std::array<std::array<double, max_terms>, states> weight; ///< by rank among the car's states
};

/// \param side   0: the mean of the tracks, 1: half the difference
/// \param event  a sample after the first
/// \param push   effect of the stations since the previous sample
SparseTransition step_sums(std::size_t side,
                           const DriveRecord& drive,
                           const SampleOrder& event,
                           const StateLayout& layout,
                           const RoadPush& push);

} // namespace macadam
