#include "render/labels/label_boxes.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {

bool overlap(const PixelBox& a, const PixelBox& b) {
    return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

PixelBox both(const PixelBox& a, const PixelBox& b) {
    return {std::min(a.left, b.left),
            std::min(a.top, b.top),
            std::max(a.right, b.right),
            std::max(a.bottom, b.bottom)};
}

PixelBox box_around(std::span<const PixelPoint> points, double margin_px) {
    PixelBox box{points[0].x, points[0].y, points[0].x, points[0].y};
    for (const auto& point : points) {
        box = both(box, {point.x, point.y, point.x, point.y});
    }
    return {
        box.left - margin_px, box.top - margin_px, box.right + margin_px, box.bottom + margin_px};
}

template <typename Visit>
void BoxGrid::visit_squares(const PixelBox& box, const Visit& visit) const {
    const auto at = [&](double px) { return std::int32_t(std::floor(px / square_px_)); };
    for (auto row = at(box.top); row <= at(box.bottom); ++row) {
        for (auto column = at(box.left); column <= at(box.right); ++column) {
            if (visit(std::uint64_t(std::uint32_t(row)) << 32 | std::uint32_t(column))) {
                return;
            }
        }
    }
}

void BoxGrid::add(const PixelBox& box, std::size_t number) {
    visit_squares(box, [&](std::uint64_t square) {
        squares_[square].push_back(number);
        return false;
    });
}

void BoxGrid::remove(const PixelBox& box, std::size_t number) {
    visit_squares(box, [&](std::uint64_t square) {
        std::erase(squares_[square], number);
        return false;
    });
}

bool BoxGrid::any_near(const PixelBox& box, const std::function<bool(std::size_t)>& is_hit) const {
    bool found = false;
    visit_squares(box, [&](std::uint64_t square) {
        const auto here = squares_.find(square);
        found = here != squares_.end() && std::ranges::any_of(here->second, is_hit);
        return found;
    });
    return found;
}

} // namespace macadam
