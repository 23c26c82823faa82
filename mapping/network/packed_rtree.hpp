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

/// Returns the smallest grid box that contains `box`, which is not empty.
GridBox on_grid(const GeoBox& box);

/// A static R-tree over numbered boxes: the boxes in the order of a Hilbert curve through their
/// centres, then level by level the boxes around each `box_tree_fan_out` of the level below, up to
/// the root. Consists of these two arrays only, so it can be stored in a file.
///
/// Source: I. Kamel and C. Faloutsos, "On Packing R-trees", Proc. CIKM 1993, pp. 490-499.
struct PackedRtree {
    std::span<const GridBox> boxes; ///< leaves, then each level of parents; the root is last
    std::span<const std::uint32_t> numbers; ///< one per leaf
};

inline constexpr std::size_t box_tree_fan_out = 16;

/// Storage of a PackedRtree.
struct BoxTreeArrays {
    std::vector<GridBox> boxes;
    std::vector<std::uint32_t> numbers;
};

/// Returns the total number of boxes for so many leaves.
std::size_t box_tree_size(std::size_t leaves);

/// Builds the tree.
///
/// \param leaves   any number of boxes, including none
/// \param numbers  one per box; several boxes may share a number
BoxTreeArrays build_box_tree(std::vector<GridBox> leaves, std::vector<std::uint32_t> numbers);

/// Returns the numbers of the boxes that intersect or touch `box`, each once, ascending.
std::vector<std::uint32_t> numbers_meeting(const PackedRtree& tree, const GridBox& box);

} // namespace macadam
