#pragma once

#include "render/scene/scene.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// Reference to a MapLine, optionally reversed.
struct LineUse {
    std::size_t line;
    bool reversed = false;
    friend bool operator==(const LineUse&, const LineUse&) = default;
};

/// Returns every line that has a direction (two different positions).
std::vector<LineUse> all_lines(std::span<const MapLine> lines);

/// Returns the lines, with only the worse direction of two-way roads, oriented along its way.
std::vector<LineUse> worse_of_both_ways(std::span<const MapLine> lines);

/// Successor and predecessor of each use, or no_neighbour.
struct Neighbours {
    std::vector<std::size_t> next, previous;
};

inline constexpr std::size_t no_neighbour = SIZE_MAX;

/// Finds lines that continue each other end to end, on roads of one rank. Where more than two meet,
/// the straightest pairs are joined; turns are limited to 70 degrees. The result at a position
/// depends only on the lines that end there and on their order.
Neighbours neighbours_of(std::span<const MapLine> lines, const std::vector<LineUse>& uses);

/// Joins neighbours to chains.
std::vector<std::vector<LineUse>> joined(std::span<const MapLine> lines,
                                         const std::vector<LineUse>& uses);

} // namespace macadam
