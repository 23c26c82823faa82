#pragma once

#include <cstdint>
#include <vector>

namespace macadam {

/// A largest set of values that rise strictly: 1 for each that belongs to it. Of several such sets
/// the one whose members come first.
///
/// Source: the longest increasing subsequence by patience sorting; M. L. Fredman, "On computing the
/// length of longest increasing subsequences", Discrete Mathematics 11 (1975), pp. 29-35. Values
/// that rise already cost one pass.
std::vector<std::uint8_t> longest_increasing_subsequence(const std::vector<double>& values);

} // namespace macadam
