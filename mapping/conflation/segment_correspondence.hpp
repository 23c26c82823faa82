#pragma once

#include "mapping/conflation/network_conflation.hpp"
#include "mapping/network/segment.hpp"
#include "mapping/passes/chunk_trace.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Stations along a way in one driving direction; they rise.
struct WayMeasureRange {
    double from_m;
    double to_m;
    friend bool operator==(const WayMeasureRange&, const WayMeasureRange&) = default;
};

inline double length_m(const WayMeasureRange& range) {
    return range.to_m - range.from_m;
}

/// The way's number; nothing if the network has none of that id.
std::optional<std::uint32_t> way_numbered(const RoadNetwork& roads, std::int64_t id);

/// Where a segment lies; nothing if the network has no such segment, or nobody may drive it so.
std::optional<WayMeasureRange> stations_of(const RoadNetwork& roads, const SegmentKey& key);

/// How many segments a chunk has; 0 if the network has no such chunk.
std::uint32_t segments_of_chunk(const RoadNetwork& roads, const ChunkKey& chunk);

/// A piece of an old segment that is a piece of a new one.
struct SegmentCorrespondence {
    SegmentKey after;
    WayMeasureRange before_m; ///< of the piece, along the old way
    WayMeasureRange after_m;  ///< of the piece, along the new way
    WayMeasureRange whole_m;  ///< of the new segment
};

/// A chunk that lies where it did, with the same segments: every old station plus `shift_m` is the
/// new one.
struct ShiftedChunk {
    ChunkKey chunk;
    double shift_m;
};

/// What has become of the segments of an old network.
class SegmentCorrespondences {
public:
    /// All outlive this.
    SegmentCorrespondences(const RoadNetwork& before,
                           const RoadNetwork& after,
                           const NetworkChange& change);

    /// Nothing has become of it as far as none is told. A segment of a kept way is its own heir.
    /// In driving direction.
    std::vector<SegmentCorrespondence> of(const SegmentKey& before) const;

    /// The one segment that it is now, with both its ends where they were, to a decimetre.
    std::optional<SegmentCorrespondence> unchanged(const SegmentKey& before) const;

    /// Nothing if its segments are not all there, unchanged, and together one chunk.
    std::optional<ShiftedChunk> moved(const ChunkKey& before) const;

    /// Where a stretch is now: nothing if less than nine tenths of it are there, or on two ways.
    std::optional<DirectedPart> stretch(const DirectedPart& before) const;

    bool is_kept(std::int64_t way_id) const;

    const RoadNetwork& before() const { return *before_; }
    const RoadNetwork& after() const { return *after_; }

private:
    const RoadNetwork* before_;
    const RoadNetwork* after_;
    const NetworkChange* change_;
};

} // namespace macadam
