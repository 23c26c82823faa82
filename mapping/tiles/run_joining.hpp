#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace macadam {

/// Joins each run shorter than `min_length` with the neighbour along the road that is nearest to
/// it, the shortest run first (on a tie of neighbours, the one before), and the result with
/// neighbours now alike.
///
/// \param runs      along a road; each has a `length`
/// \param is_alike  (a, b): whether two neighbours look the same
/// \param join      (run, next): adds the run after it
/// \param apart     (a, b): difference of their values, not negative
template <typename Run, typename IsAlike, typename Join, typename Apart>
void join_short_runs(std::vector<Run>& runs,
                     double min_length,
                     const IsAlike& is_alike,
                     const Join& join,
                     const Apart& apart) {
    const auto take_next = [&](std::size_t at) {
        join(runs[at], runs[at + 1]);
        runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(at) + 1);
    };
    const auto neighbour_of = [&](std::size_t i) {
        if (i == 0 || i + 1 == runs.size()) {
            return i == 0 ? 1 : i - 1;
        }
        return apart(runs[i - 1], runs[i]) <= apart(runs[i + 1], runs[i]) ? i - 1 : i + 1;
    };
    while (runs.size() > 1) {
        const auto shortest = std::ranges::min_element(runs, {}, &Run::length);
        if (shortest->length >= min_length) {
            return;
        }
        const auto found = static_cast<std::size_t>(shortest - runs.begin());
        const auto i = std::min(found, neighbour_of(found));
        take_next(i);
        if (i + 1 < runs.size() && is_alike(runs[i], runs[i + 1])) {
            take_next(i);
        }
        if (i > 0 && is_alike(runs[i - 1], runs[i])) {
            take_next(i - 1);
        }
    }
}

} // namespace macadam
