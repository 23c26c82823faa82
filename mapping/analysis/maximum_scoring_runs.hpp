#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace macadam {

/// A half-open index range: first <= i < last.
struct IndexRange {
    std::size_t first;
    std::size_t last;
    friend bool operator==(const IndexRange&, const IndexRange&) = default;
};

/// Finds all maximal scoring subsequences: the longest runs in which every prefix and every suffix
/// has a positive sum. In order; O(n).
///
/// Source: W. L. Ruzzo and M. Tompa, "A linear time algorithm for finding all maximal scoring
/// subsequences", ISMB 1999, pp. 234-241.
std::vector<IndexRange> maximal_scoring_runs(std::span<const double> scores);

} // namespace macadam
