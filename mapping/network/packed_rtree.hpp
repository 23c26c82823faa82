#pragma once

#include "estimator/common/geo.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// A box on the grid of 1e-7 degrees. south <= north and west <= east.
struct GridBox {
    std::int32_t south_e7;
    std::int32_t west_e7;
    std::int32_t north_e7;
    std::int32_t east_e7;
    friend bool operator==(const GridBox&, const GridBox&) = default;
};

/// The smallest grid box that holds `box`, which is not empty.
GridBox on_grid(const GeoBox& box);

/// A static R-tree over boxes, each with a number: the boxes in the order of a Hilbert curve
/// through their middles, then level upon level the boxes around each `box_tree_fan_out` of the
/// level below, up to the root. Needs nothing but these two arrays, so it can lie in a file.
///
/// Source: I. Kamel and C. Faloutsos, "On Packing R-trees", Proc. CIKM 1993, pp. 490-499.
struct PackedRtree {
    std::span<const GridBox> boxes;         ///< leaves, then their parents, ..., last the root
    std::span<const std::uint32_t> numbers; ///< of the leaves; as many as leaves
};

inline constexpr std::size_t box_tree_fan_out = 16;

/// What a PackedRtree looks into.
struct BoxTreeArrays {
    std::vector<GridBox> boxes;
    std::vector<std::uint32_t> numbers;
};

/// Boxes in all for so many leaves.
std::size_t box_tree_size(std::size_t leaves);

/// \param leaves   any number of boxes, also none
/// \param numbers  as many; the same one may stand at several boxes
BoxTreeArrays build_box_tree(std::vector<GridBox> leaves, std::vector<std::uint32_t> numbers);

/// Numbers of the boxes that meet `box` or touch it, each once, rising.
std::vector<std::uint32_t> numbers_meeting(const PackedRtree& tree, const GridBox& box);

} // namespace macadam
