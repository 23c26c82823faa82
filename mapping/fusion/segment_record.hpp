#pragma once

#include "mapping/fusion/segment_state.hpp"
#include "mapping/network/segment.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// A segment in its place with what is known of it.
struct SegmentRecord {
    Segment segment;
    std::string name;                  ///< of the road, "" where the map has none
    std::string highway;               ///< OSM's class, "" where there is none
    std::optional<SegmentState> state; ///< nothing: no pass yet
};

/// What a map shows of a segment. What it points at lasts until the next one is shown.
struct SegmentSummary {
    /// As in its SegmentState.
    struct Roughness {
        IriUm iri_um;
        IriUm sd_um;
        std::int32_t passes;
    };

    SegmentKey key;
    std::span<const GeoPoint> line;
    std::string_view name;              ///< as in its SegmentRecord
    std::string_view highway;           ///< as in its SegmentRecord
    std::optional<Roughness> roughness; ///< nothing: no pass yet
};

} // namespace macadam
