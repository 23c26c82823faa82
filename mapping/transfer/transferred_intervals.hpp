#pragma once

#include "mapping/transfer/transferred_passes.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace macadam {

/// Part of a pass on an interval of a new segment.
struct TransferredInterval {
    const Pass* pass; ///< the old pass
    ChunkKey old_chunk;
    SegmentCorrespondence correspondence;
    double covered_m; ///< length along the new way
    double t_ms;      ///< at the midpoint of the interval
};

/// Intervals on one chunk of the new network, in order of time.
using ChunkIntervals = std::vector<TransferredInterval>;

/// The intervals of one drive over a new chunk, in order of time.
struct TransferredDrive {
    std::optional<std::uint32_t> number; ///< `std::nullopt`: its passes belong to no drive
    std::vector<TransferredInterval> intervals;
};

/// Groups the intervals of passes by new chunk, in key order of the chunks.
std::vector<ChunkIntervals> intervals_by_chunk(const std::vector<Pass>& passes,
                                               const SegmentCorrespondences& correspondences);

/// Separates drives as driven_parts does: a drive has continuous stations, without a gap of more
/// than 20 m or of much more time than the distance takes.
std::vector<TransferredDrive> drives_of(const ChunkIntervals& intervals);

} // namespace macadam
