#pragma once

#include "render/map.hpp"

#include <span>
#include <vector>

namespace macadam {

/// A MapLine, perhaps taken against its direction.
struct LineUse {
    std::size_t line;
    bool reversed = false;
    friend bool operator==(const LineUse&, const LineUse&) = default;
};

/// Every line that has a direction (two places that differ).
std::vector<LineUse> all_lines(std::span<const MapLine> lines);

/// The same where of two directions of one piece of road only the worse is left, laid along its
/// way.
std::vector<LineUse> worse_of_both_ways(std::span<const MapLine> lines);

/// Lines that follow each other end to end, on roads of one rank, become chains. Where more than
/// two meet the straightest pairs go on; nothing turns by more than 70 degrees.
std::vector<std::vector<LineUse>> joined(std::span<const MapLine> lines,
                                         const std::vector<LineUse>& uses);

} // namespace macadam
