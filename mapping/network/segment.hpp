#pragma once

#include "mapping/network/road_network.hpp"

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace macadam {

/// Persistent key of about 20 m of road in one direction, independent of the loaded network: way,
/// direction, number along the way.
struct SegmentKey {
    std::int64_t way_id;
    bool forward;
    std::uint32_t index;
    friend bool operator==(const SegmentKey&, const SegmentKey&) = default;

    /// Orders by way, forward before backward, index: the order of every output.
    friend std::strong_ordering operator<=>(const SegmentKey& a, const SegmentKey& b) {
        return std::tuple{a.way_id, !a.forward, a.index} <=>
               std::tuple{b.way_id, !b.forward, b.index};
    }
};

/// A range of segments in one direction of a way: first <= index < past.
struct SegmentRange {
    std::int64_t way_id;
    bool forward;
    std::uint32_t first;
    std::uint32_t past;
    friend bool operator==(const SegmentRange&, const SegmentRange&) = default;
};

/// Formats a key: "123456+0007" forward, "123456-0007" backward. At least four digits.
std::string name_of(const SegmentKey& key);

/// Parses a formatted key.
///
/// \throws InputError  if the text is not a valid key.
SegmentKey parse_segment_key(std::string_view text);

/// A segment with its geometry. from_m < to_m along the way from its first node in either driving
/// direction; `line` is in driving direction.
struct Segment {
    SegmentKey key;
    double from_m;
    double to_m;
    std::vector<GeoPoint> line;
};

/// Returns the segments of one edge in driving direction: equal parts of it.
std::vector<Segment> segments_of(const RoadNetwork& roads, EdgeId edge);

/// Returns the positions along an interval of an edge, offsets in its direction of travel; from_m
/// <= to_m, both on the edge.
std::vector<GeoPoint> line_on(const RoadNetwork& roads, EdgeId edge, double from_m, double to_m);

} // namespace macadam
