#pragma once

#include "mapping/fusion/fusion.hpp"
#include "mapping/fusion/segment_state.hpp"
#include "mapping/privacy/release_batches.hpp"

#include <cstdint>
#include <span>

namespace macadam {

/// Rounds a count down to one of 5, 10, 20, 50, 100, ...; 0 below 5. Exact counts of neighbouring
/// segments would reveal where single trips end.
std::int32_t published_count(std::int32_t count);

/// Coarsens a state for publication: dates to months, counts by published_count(), IRI to 0.01 mm/m
/// and its uncertainty up to multiples of 0.05. A change of the road is published only if enough
/// cars passed both before and after it.
///
/// \param passes  from which the state was fused.
SegmentState
published(SegmentState state, std::span<const FusionInput> passes, const ReleaseRule& rule);

} // namespace macadam
