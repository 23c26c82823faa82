#pragma once

#include "mapping/fusion/segment_record.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Measured segment without its line, as statistics and sections of roads need it: 120 bytes, so
/// that a network of a million fits into memory.
struct MeasuredSegment {
    SegmentKey key;
    double from_m, to_m;      ///< as in Segment
    std::string_view name;    ///< as in SegmentRecord; its text must outlive the segment
    std::string_view highway; ///< likewise
    IriUm iri_um, sd_um;      ///< as in SegmentState, like the rest
    std::int32_t passes, vehicles;
    std::uint8_t validity;
    bool centre_only;
    std::optional<std::int64_t> first_seen_ms, last_seen_ms;
};

/// Returns what is known of a record, whose texts must outlive it.
/// \param record  with a state
MeasuredSegment measured_segment(const SegmentRecord& record);

/// Measured segments with the texts that they refer to, each text once.
struct MeasuredSegments {
    std::vector<MeasuredSegment> segments{};
    std::shared_ptr<std::set<std::string, std::less<>>> texts =
        std::make_shared<std::set<std::string, std::less<>>>();

    /// \param record  with a state
    void add(const SegmentRecord& record);
};

} // namespace macadam
