#pragma once

#include "mapping/conflation/network_conflation.hpp"
#include "mapping/network/segment.hpp"
#include "mapping/passes/chunk_trace.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Ascending stations along a way in one driving direction.
struct WayMeasureRange {
    double from_m;
    double to_m;
    friend bool operator==(const WayMeasureRange&, const WayMeasureRange&) = default;
};

inline double length_m(const WayMeasureRange& range) {
    return range.to_m - range.from_m;
}

/// Returns the way's number, or `std::nullopt` if the network has no way of that id.
std::optional<std::uint32_t> way_numbered(const RoadNetwork& roads, std::int64_t id);

/// Returns the stations of a segment, or `std::nullopt` if the network has no such segment or the
/// direction is not drivable.
std::optional<WayMeasureRange> stations_of(const RoadNetwork& roads, const SegmentKey& key);

/// Returns the number of segments of a chunk; 0 if the network has no such chunk.
std::uint32_t segments_of_chunk(const RoadNetwork& roads, const ChunkKey& chunk);

/// An interval of an old segment that is an interval of a new one.
struct SegmentCorrespondence {
    SegmentKey after;
    WayMeasureRange before_m; ///< the interval along the old way
    WayMeasureRange after_m;  ///< the interval along the new way
    WayMeasureRange whole_m;  ///< the entire new segment
};

/// A chunk with the same position and segments in both networks: new station = old station +
/// `shift_m`.
struct ShiftedChunk {
    ChunkKey chunk;
    double shift_m;
};

/// Maps segments of an old network to a new one.
class SegmentCorrespondences {
public:
    /// All arguments outlive this object.
    SegmentCorrespondences(const RoadNetwork& before,
                           const RoadNetwork& after,
                           const NetworkChange& change);

    /// Returns the corresponding intervals in driving direction; parts of the segment without a
    /// correspondence are lost. A segment of a kept way corresponds to itself.
    std::vector<SegmentCorrespondence> of(const SegmentKey& before) const;

    /// Returns the single segment that now has both ends in the same positions, to a decimetre.
    std::optional<SegmentCorrespondence> unchanged(const SegmentKey& before) const;

    /// Returns `std::nullopt` unless all segments of the chunk are unchanged and together form one
    /// chunk.
    std::optional<ShiftedChunk> moved(const ChunkKey& before) const;

    /// Returns the new position of an interval, or `std::nullopt` if less than nine tenths of it
    /// are left or it lies on two ways.
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
