#pragma once

#include "mapping/network/network_records.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace macadam {

/// A way with the positions of its nodes.
struct PlacedWay {
    std::int64_t id;
    std::vector<std::int64_t> nodes;
    std::vector<PackedPoint> points; ///< one for each node
};

/// Assembles the rings of an area from the ways around it, in any order and direction.
///
/// \param take  receives each outer ring followed by the holes in it, without repeated points
/// \returns false if the ways make no valid area: rings are open or cross each other.
bool assemble_area(std::span<const PlacedWay* const> ways,
                   const std::function<void(std::vector<std::vector<PackedPoint>> rings)>& take);

} // namespace macadam
