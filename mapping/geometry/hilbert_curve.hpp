#pragma once

#include <cstdint>
#include <utility>

namespace macadam {

/// Returns the distance along the Hilbert curve that fills a square of 2^bits cells a side, from
/// cell (0, 0); the curve enters the quarters in the order (0, 0), (0, 1), (1, 1), (1, 0).
///
/// \param bits  at most 32.
///
/// Source: H. S. Warren, "Hacker's Delight", 2nd ed. (2012), chapter 16: the state is one of four
/// orientations, here as a swap and a complement of the two coordinates.
constexpr std::uint64_t hilbert_distance(std::uint32_t x, std::uint32_t y, unsigned bits) {
    std::uint64_t distance = 0;
    for (auto bit = bits; bit-- > 0;) {
        const auto right = x >> bit & 1U;
        const auto up = y >> bit & 1U;
        distance = distance << 2U | ((3U * right) ^ up);
        if (up == 0) {
            if (right == 1) {
                x = ~x;
                y = ~y;
            }
            std::swap(x, y);
        }
    }
    return distance;
}

} // namespace macadam
