#pragma once

#include <algorithm>

namespace macadam {

/// Box in the plane with its borders, in the unit of the lines that are clipped.
struct ClipBox {
    double low_x, low_y, high_x, high_y;
};

/// Part of a straight line, as fractions of its length from its start; from > to: none.
struct ClippedPart {
    double from = 0, to = 1;

    bool is_empty() const { return from > to; }
};

/// Clips the straight line from `a` to `b`, points with members x and y, to a box.
///
/// Source: Liang and Barsky, "A new concept and method for line clipping", ACM Transactions on
/// Graphics 3 (1984), pp. 1-22.
template <typename Point>
ClippedPart clipped_line(const Point& a, const Point& b, const ClipBox& box) {
    ClippedPart part;
    const auto clip = [&](double start, double step, double low, double high) {
        if (step == 0) {
            part = start < low || start > high ? ClippedPart{1, 0} : part;
            return;
        }
        const auto [enter, leave] = std::minmax({(low - start) / step, (high - start) / step});
        part.from = std::max(part.from, enter);
        part.to = std::min(part.to, leave);
    };
    clip(double(a.x), double(b.x) - double(a.x), box.low_x, box.high_x);
    clip(double(a.y), double(b.y) - double(a.y), box.low_y, box.high_y);
    return part;
}

} // namespace macadam
