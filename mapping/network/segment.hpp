#pragma once

#include "mapping/network/road_network.hpp"

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace macadam {

/// The name of about 20 m of road in one direction that outlives the loaded network: its way, its
/// direction, its number along the way.
struct SegmentKey {
    std::int64_t way_id;
    bool forward;
    std::uint32_t index;
    friend bool operator==(const SegmentKey&, const SegmentKey&) = default;

    /// By way, forward before backward, index: the order of every output.
    friend std::strong_ordering operator<=>(const SegmentKey& a, const SegmentKey& b) {
        return std::tuple{a.way_id, !a.forward, a.index} <=>
               std::tuple{b.way_id, !b.forward, b.index};
    }
};

/// Segments of one direction of a way by their numbers: first <= index < past.
struct SegmentRange {
    std::int64_t way_id;
    bool forward;
    std::uint32_t first;
    std::uint32_t past;
    friend bool operator==(const SegmentRange&, const SegmentRange&) = default;
};

/// "123456+0007" forward, "123456-0007" backward. At least four digits.
std::string name_of(const SegmentKey& key);

/// \throws InputError  if the text is not such a name.
SegmentKey parse_segment_key(std::string_view text);

/// A segment in its place. from_m < to_m along the way from its first node, whatever the driving
/// direction; `line` runs in driving direction.
struct Segment {
    SegmentKey key;
    double from_m;
    double to_m;
    std::vector<GeoPoint> line;
};

/// The segments of one edge, in driving direction: equal parts of it.
std::vector<Segment> segments_of(const RoadNetwork& roads, EdgeId edge);

/// Places along a part of an edge, offsets in its direction of travel; from_m <= to_m, both on it.
std::vector<GeoPoint> line_on(const RoadNetwork& roads, EdgeId edge, double from_m, double to_m);

} // namespace macadam
