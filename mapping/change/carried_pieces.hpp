#pragma once

#include "mapping/carried_readings.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace macadam {

/// What a pass says of a piece of a new segment.
struct CarriedPiece {
    const Pass* pass; ///< the old one
    StripKey old_strip;
    Heir heir;
    double covered_m; ///< of the piece, along the new way
    double t_ms;      ///< in the middle of the piece
};

/// In the order of time, for each strip of the new network.
using StripPieces = std::vector<CarriedPiece>;

/// The pieces of one drive over a new strip, in the order of time.
struct CarriedDrive {
    std::optional<std::uint32_t> number; ///< nothing: its passes belong to none
    std::vector<CarriedPiece> pieces;
};

/// The pieces of passes by new strip, in the order of the strips' keys.
std::vector<StripPieces> pieces_by_strip(const std::vector<Pass>& passes,
                                         const SegmentHeirs& heirs);

/// As driven_parts tells drives apart: stations that go on, without a gap of more than 20 m or of
/// much more time than it takes.
std::vector<CarriedDrive> drives_of(const StripPieces& pieces);

} // namespace macadam
