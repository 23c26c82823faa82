#pragma once

#include "mapping/fusion.hpp"
#include "mapping/segment.hpp"

#include <optional>
#include <string>

namespace macadam {

/// A segment in its place with what is known of it.
struct SegmentRecord {
    Segment segment;
    std::string name;                  ///< of the road, "" where the map has none
    std::string highway;               ///< OSM's class, "" where there is none
    std::optional<SegmentState> state; ///< nothing: no pass yet
};

} // namespace macadam
