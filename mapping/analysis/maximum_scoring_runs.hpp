#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace macadam {

/// A part of a row: first <= i < last.
struct IndexRange {
    std::size_t first;
    std::size_t last;
    friend bool operator==(const IndexRange&, const IndexRange&) = default;
};

/// The parts of a row of scores of which every beginning and every end adds up to more than zero,
/// each as long as that stays so; in their order. O(n).
///
/// Source: W. L. Ruzzo and M. Tompa, "A linear time algorithm for finding all maximal scoring
/// subsequences", ISMB 1999, pp. 234-241.
std::vector<IndexRange> maximal_scoring_runs(std::span<const double> scores);

} // namespace macadam
