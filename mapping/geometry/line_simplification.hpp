#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace macadam {

/// Marks the vertices between two kept ones, `first` and `last`, that a line needs so that it
/// deviates nowhere by more than the tolerance.
///
/// \param deviation  deviation(i, first, last) of vertex i from the straight line between two
///                   others, in the unit of the tolerance.
/// \param is_kept    one flag a vertex.
///
/// Source: D. H. Douglas and T. K. Peucker, "Algorithms for the reduction of the number of points
/// required to represent a digitized line or its caricature", The Canadian Cartographer 10 (1973),
/// pp. 112-122.
template <typename Deviation>
void keep_bends(std::size_t first,
                std::size_t last,
                double tolerance,
                Deviation deviation,
                std::vector<bool>& is_kept) {
    std::vector<std::pair<std::size_t, std::size_t>> open{{first, last}}; // a line may be very long
    while (!open.empty()) {
        const auto [from, to] = open.back();
        open.pop_back();
        auto bend = from;
        double farthest = tolerance;
        for (auto i = from + 1; i < to; ++i) {
            if (const double off = deviation(i, from, to); off > farthest) {
                farthest = off;
                bend = i;
            }
        }
        if (bend != from) {
            is_kept[bend] = true;
            open.emplace_back(from, bend);
            open.emplace_back(bend, to);
        }
    }
}

} // namespace macadam
