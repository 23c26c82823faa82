#pragma once

#include "mapping/fusion/fusion.hpp"
#include "mapping/fusion/segment_state.hpp"
#include "mapping/privacy/release_batches.hpp"

#include <cstdint>
#include <span>

namespace macadam {

/// The largest of 5, 10, 20, 50, 100, ... that is not above the count; 0 below 5. Exact counts of
/// neighbouring segments would tell where single trips end.
std::int32_t told_count(std::int32_t count);

/// What a publication tells of a state: dates by month, counts as told_count() has them, IRI to
/// 0.01 mm/m and its uncertainty, upward, to 0.05. A change of the road is told only where enough
/// cars passed before it and as many after it.
///
/// \param passes  from which the state was fused.
SegmentState
published(SegmentState state, std::span<const FusionInput> passes, const ReleaseRule& rule);

} // namespace macadam
