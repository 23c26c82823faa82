#include "mapping/geometry/rings_around.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace macadam {
namespace {

/// Side of a ring.
struct Side {
    RingPoint low, high;
    std::size_t ring;
};

/// Returns the sides of rings that are not level, from the lowest start up.
std::vector<Side> sides_of(std::span<const std::vector<RingPoint>> rings) {
    std::vector<Side> sides;
    for (std::size_t number = 0; number < rings.size(); ++number) {
        const auto& ring = rings[number];
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const auto& a = ring[i];
            const auto& b = ring[(i + 1) % ring.size()];
            if (a.y != b.y) {
                sides.push_back({a.y < b.y ? a : b, a.y < b.y ? b : a, number});
            }
        }
    }
    std::ranges::stable_sort(sides, {}, [](const Side& side) { return side.low.y; });
    return sides;
}

} // namespace

std::optional<std::vector<std::size_t>> rings_around(std::span<const std::vector<RingPoint>> rings,
                                                     std::span<const RingPoint> points,
                                                     std::size_t max_comparisons) {
    const auto sides = sides_of(rings);
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return points[i].y; });
    std::vector<std::size_t> found(points.size(), rings.size());
    std::vector<std::size_t> active;
    std::vector<std::uint8_t> is_within(rings.size(), 0);
    std::size_t next = 0;
    std::size_t comparisons = 0;
    for (const auto number : order) {
        const auto& point = points[number];
        for (; next < sides.size() && sides[next].low.y <= point.y; ++next) {
            active.push_back(next);
        }
        comparisons += active.size();
        if (comparisons > max_comparisons) {
            return {};
        }
        std::erase_if(active, [&](std::size_t side) { return sides[side].high.y <= point.y; });
        for (const auto side : active) {
            const auto& [low, high, ring] = sides[side];
            const double x = low.x + (point.y - low.y) / (high.y - low.y) * (high.x - low.x);
            is_within[ring] ^= x > point.x ? 1 : 0;
        }
        for (const auto side : active) {
            auto& is_around = is_within[sides[side].ring];
            found[number] =
                is_around != 0 ? std::min(found[number], sides[side].ring) : found[number];
            is_around = 0;
        }
    }
    return found;
}

} // namespace macadam
