#pragma once

#include "render/scene/scene.hpp"

#include <cstdint>
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

/// For each use the one that it goes on into and the one that goes on into it, or no_neighbour.
struct Neighbours {
    std::vector<std::size_t> next, previous;
};

inline constexpr std::size_t no_neighbour = SIZE_MAX;

/// Lines go on into each other end to end, on roads of one rank. Where more than two meet the
/// straightest pairs go on; nothing turns by more than 70 degrees. What goes on at a place depends
/// on the lines that end there and on their order, on nothing else.
Neighbours neighbours_of(std::span<const MapLine> lines, const std::vector<LineUse>& uses);

/// Neighbours in a row become chains.
std::vector<std::vector<LineUse>> joined(std::span<const MapLine> lines,
                                         const std::vector<LineUse>& uses);

} // namespace macadam
