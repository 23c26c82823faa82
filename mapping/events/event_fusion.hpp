#pragma once

#include "mapping/events/pass_event.hpp"
#include "mapping/network/segment.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace macadam {

/// Event of one pass as fusion takes it.
struct EventReport {
    PassEvent event;
    double station_m; ///< of the event, after alignment (mapping/passes/chunk_trace.hpp)
    std::int64_t trip;
    std::int64_t vehicle;
    std::optional<std::int64_t> utc_ms; ///< of the pass
};

/// Segment with the times of the passes over it that were searched for events.
struct SearchedSegment {
    SegmentKey key;
    double from_station_m; ///< rising in driving direction
    double to_station_m;
    std::vector<std::optional<std::int64_t>> passes_utc_ms;
};

/// Event of the road, as its passes agree on it.
struct FusedEvent {
    SegmentKey segment;
    EventKind kind;
    WheelTrack track;
    std::int64_t at_mm;       ///< along the way, from its first node
    std::int32_t place_sd_mm; ///< of at_mm
    std::int32_t size_um;     ///< as PassEvent::size_um, mean by inverse variance
    std::int32_t sd_um;       ///< of size_um
    std::int32_t length_mm;   ///< median
    std::int32_t passes;      ///< that report it
    std::int32_t passes_over; ///< that were searched there since the first report
    std::int32_t vehicles;    ///< of the passes that report it
    std::optional<std::int64_t> first_seen_ms;
    std::optional<std::int64_t> last_seen_ms;
    std::vector<std::int64_t> cars{}; ///< that report it, ascending; empty if only counts are known
    friend bool operator==(const FusedEvent&, const FusedEvent&) = default;
};

/// Rule by which reports of passes become an event of the road.
struct EventRule {
    /// Largest distance of a report from the middle of its event. Aligned drives agree within
    /// 0.5 m, others within the error of GNSS.
    double window_m = 2;

    /// One pass alone may be wrong: on a measured road 0.04 false alarms a kilometre, which two
    /// passes repeat at one place and kind hardly ever.
    std::int32_t min_passes = 2;

    /// Reporting passes over all passes at this position since the first report. A pass finds 92 %
    /// of the potholes deeper than 25 mm; the rest of the allowance is for cars that drive beside
    /// the hole. After a repair an event ends when twice as many passes found nothing.
    double min_share = 1.0 / 3;
};

/// Fuses the events of passes over one direction of a way: clusters of one kind within the window,
/// of which no pass has two reports. Reports of the left and of the right track are never one
/// event; those of both tracks or an unknown one join either.
///
/// The result does not depend on the order of the reports.
///
/// \param segments  of the way, in driving order
/// \returns         in the order of (station, kind)
std::vector<FusedEvent> fuse_events(std::vector<EventReport> reports,
                                    std::span<const SearchedSegment> segments,
                                    const EventRule& rule = {});

} // namespace macadam
