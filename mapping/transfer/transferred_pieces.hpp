#pragma once

#include "mapping/transfer/transferred_passes.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace macadam {

/// What a pass says of a piece of a new segment.
struct CarriedPiece {
    const Pass* pass; ///< the old one
    ChunkKey old_chunk;
    SegmentCorrespondence correspondence;
    double covered_m; ///< of the piece, along the new way
    double t_ms;      ///< in the middle of the piece
};

/// In the order of time, for each chunk of the new network.
using ChunkPieces = std::vector<CarriedPiece>;

/// The pieces of one drive over a new chunk, in the order of time.
struct CarriedDrive {
    std::optional<std::uint32_t> number; ///< nothing: its passes belong to none
    std::vector<CarriedPiece> pieces;
};

/// The pieces of passes by new chunk, in the order of the chunks' keys.
std::vector<ChunkPieces> pieces_by_chunk(const std::vector<Pass>& passes,
                                         const SegmentCorrespondences& correspondences);

/// As driven_parts tells drives apart: stations that go on, without a gap of more than 20 m or of
/// much more time than it takes.
std::vector<CarriedDrive> drives_of(const ChunkPieces& pieces);

} // namespace macadam
