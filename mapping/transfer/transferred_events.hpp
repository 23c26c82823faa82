#pragma once

#include "mapping/conflation/segment_correspondence.hpp"
#include "mapping/events/pass_event.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace macadam {

/// Occurrence of the new pass over a segment that is made from the old pass of an event;
/// `std::nullopt` if there is none.
using NewOccurrence =
    std::function<std::optional<std::uint32_t>(const PassEvent& old, const SegmentKey& after)>;

/// Transfers events to a new network, each to the place that its own has there. An event whose
/// place is gone, or whose pass has become too short, is lost.
std::vector<PassEvent> carried_events(std::span<const PassEvent> old,
                                      const SegmentCorrespondences& correspondences,
                                      const NewOccurrence& occurrence);

} // namespace macadam
