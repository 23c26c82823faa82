#include "mapping/network/packed_rtree.hpp"

#include "mapping/geometry/hilbert_curve.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t max_levels = 9; // 32 bits number at most 16^8 leaves

bool meet(const GridBox& a, const GridBox& b) {
    return a.south_e7 <= b.north_e7 && b.south_e7 <= a.north_e7 && a.west_e7 <= b.east_e7 &&
           b.west_e7 <= a.east_e7;
}

GridBox around(const GridBox& a, const GridBox& b) {
    return {std::min(a.south_e7, b.south_e7),
            std::min(a.west_e7, b.west_e7),
            std::max(a.north_e7, b.north_e7),
            std::max(a.east_e7, b.east_e7)};
}

/// Returns the curve distance of the centre of a box, counted from the south pole and the
/// antimeridian.
std::uint64_t place_on_curve(const GridBox& box) {
    const auto middle = [](std::int32_t a, std::int32_t b) {
        return static_cast<std::uint32_t>((std::int64_t{a} + b) / 2 + (std::int64_t{1} << 31U));
    };
    return hilbert_distance(
        middle(box.west_e7, box.east_e7), middle(box.south_e7, box.north_e7), 32);
}

std::size_t parents_of(std::size_t boxes) {
    return (boxes + box_tree_fan_out - 1) / box_tree_fan_out;
}

/// Start of each level, leaves first; the last entry is the total number of boxes.
struct Levels {
    std::array<std::size_t, max_levels + 1> first{};
    std::size_t count = 0;
};

Levels levels_of(std::size_t leaves) {
    Levels levels;
    auto in_level = leaves;
    while (in_level > 0) {
        levels.first[levels.count + 1] = levels.first[levels.count] + in_level;
        ++levels.count;
        in_level = in_level == 1 ? 0 : parents_of(in_level);
    }
    return levels;
}

} // namespace

GridBox on_grid(const GeoBox& box) {
    constexpr double per_deg = 1e7;
    constexpr double max_lat_deg = 90;
    constexpr double max_lon_deg = 180;
    const auto down = [](double deg, double max_deg) {
        return static_cast<std::int32_t>(std::floor(std::clamp(deg, -max_deg, max_deg) * per_deg));
    };
    const auto up = [](double deg, double max_deg) {
        return static_cast<std::int32_t>(std::ceil(std::clamp(deg, -max_deg, max_deg) * per_deg));
    };
    return {down(box.south_deg, max_lat_deg),
            down(box.west_deg, max_lon_deg),
            up(box.north_deg, max_lat_deg),
            up(box.east_deg, max_lon_deg)};
}

std::size_t box_tree_size(std::size_t leaves) {
    const auto levels = levels_of(leaves);
    return levels.first[levels.count];
}

BoxTreeArrays build_box_tree(std::vector<GridBox> leaves, std::vector<std::uint32_t> numbers) {
    assert(leaves.size() == numbers.size());
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(leaves.size());
    for (std::uint32_t i = 0; i < leaves.size(); ++i) {
        order[i] = {place_on_curve(leaves[i]), i};
    }
    std::sort(order.begin(), order.end());

    const auto levels = levels_of(leaves.size());
    BoxTreeArrays tree;
    tree.boxes.reserve(levels.first[levels.count]);
    tree.numbers.reserve(leaves.size());
    for (const auto& [distance, leaf] : order) {
        tree.boxes.push_back(leaves[leaf]);
        tree.numbers.push_back(numbers[leaf]);
    }
    for (std::size_t level = 0; level + 1 < levels.count; ++level) {
        const auto past = levels.first[level + 1];
        for (auto first = levels.first[level]; first < past; first += box_tree_fan_out) {
            auto box = tree.boxes[first];
            for (auto i = first + 1; i < std::min(first + box_tree_fan_out, past); ++i) {
                box = around(box, tree.boxes[i]);
            }
            tree.boxes.push_back(box);
        }
    }
    return tree;
}

std::vector<std::uint32_t> numbers_meeting(const PackedRtree& tree, const GridBox& box) {
    const auto levels = levels_of(tree.numbers.size());
    std::vector<std::uint32_t> found;
    // Depth first: the boxes of a level still to be visited, [at, past).
    struct Range {
        std::size_t at = 0;
        std::size_t past = 0;
    };
    std::array<Range, max_levels> open{};
    auto level = levels.count;
    if (level > 0) {
        --level;
        open[level] = {levels.first[level], levels.first[level + 1]};
    }
    while (level < levels.count) {
        auto& range = open[level];
        if (range.at == range.past) {
            ++level;
            continue;
        }
        const auto i = range.at++;
        if (!meet(tree.boxes[i], box)) {
            continue;
        }
        if (level == 0) {
            found.push_back(tree.numbers[i]);
            continue;
        }
        const auto child = levels.first[level - 1] + (i - levels.first[level]) * box_tree_fan_out;
        --level;
        open[level] = {child, std::min(child + box_tree_fan_out, levels.first[level + 1])};
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

} // namespace macadam
