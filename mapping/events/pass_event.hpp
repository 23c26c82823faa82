#pragma once

#include "estimator/events/road_event.hpp"
#include "mapping/passes/pass.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// Event that one pass reports, in integers as a Pass.
struct PassEvent {
    SegmentKey segment;
    std::uint32_t occurrence; ///< Pass::occurrence
    EventKind kind;
    WheelTrack track;           ///< in driving direction
    std::int64_t at_mm;         ///< along the way, from its first node
    std::int32_t place_sd_mm;   ///< of at_mm, > 0
    std::int32_t size_um;       ///< RoadEvent::size_mm, >= 0
    std::int32_t sd_um;         ///< of size_um, > 0
    std::int32_t length_mm = 0; ///< RoadEvent::length_m
    friend bool operator==(const PassEvent&, const PassEvent&) = default;
};

/// Places the events of a trip on the segments of its passes, by travel. Events off the passes, or
/// with values that are not finite, are dropped: whatever hides a pass hides its events.
///
/// \param passes  of cut_trip(), in driving order
/// \returns       in the order of (segment, occurrence, at_mm, kind, track)
std::vector<PassEvent> place_events(std::span<const RoadEvent> events,
                                    std::span<const DrivenPass> passes);

} // namespace macadam
