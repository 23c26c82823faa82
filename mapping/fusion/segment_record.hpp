#pragma once

#include "mapping/fusion/segment_state.hpp"
#include "mapping/network/segment.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// A segment with its geometry and state.
struct SegmentRecord {
    Segment segment;
    std::string name;                  ///< of the road, "" if the map has none
    std::string highway;               ///< OSM's class, "" if there is none
    std::optional<SegmentState> state; ///< `std::nullopt`: no pass yet
};

/// Map display data of a segment. Its references remain valid until the next one is shown.
struct SegmentSummary {
    /// As in SegmentState.
    struct Roughness {
        IriUm iri_um;
        IriUm sd_um;
        std::int32_t passes;
    };

    SegmentKey key;
    std::span<const GeoPoint> line;
    std::string_view name;              ///< as in SegmentRecord
    std::string_view highway;           ///< as in SegmentRecord
    std::optional<Roughness> roughness; ///< `std::nullopt`: no pass yet
};

} // namespace macadam
