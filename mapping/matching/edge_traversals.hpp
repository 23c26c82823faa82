#pragma once

#include "mapping/matching/map_match.hpp"

namespace macadam {

/// Merges a trace into one interval per traversal of an edge, for output. (`map_match` also cuts a
/// traversal wherever the ratio of travel to offset changes.)
///
/// Consecutive intervals of one edge are merged: confidence is their length-weighted mean, and the
/// position's standard deviation their maximum. Consecutive gaps with the same reason are merged
/// too. Intervals shorter than `min_m`, caused by rounding at nodes and ends and by standing, are
/// absorbed by their neighbours, so that time and travel remain continuous. An edge traversed again
/// after a loop or a U-turn is a new interval.
MatchedTrace edge_traversals(const MatchedTrace& trace, double min_m = 0.05);

} // namespace macadam
