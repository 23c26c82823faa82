#include "render/canvas/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace macadam {
namespace {

std::uint8_t mixed(std::uint8_t below, std::uint32_t above, double share) {
    return std::uint8_t(std::lround(std::lerp(double(below), double(above), share)));
}

/// Returns the signed distance of a point from a rounded box; negative inside.
double outside_px(const RoundedBox& shape, const PixelPoint& at) {
    const auto& box = shape.box;
    const double x =
        std::abs(at.x - (box.left + box.right) / 2) - box.width() / 2 + shape.radius_px;
    const double y =
        std::abs(at.y - (box.top + box.bottom) / 2) - box.height() / 2 + shape.radius_px;
    return std::hypot(std::max(x, 0.0), std::max(y, 0.0)) + std::min(std::max(x, y), 0.0) -
           shape.radius_px;
}

double from_piece_px(const PixelPoint& a, const PixelPoint& b, const PixelPoint& at) {
    const double dx = b.x - a.x;
    const double dy = b.y - a.y;
    const double squared = dx * dx + dy * dy;
    const double t =
        squared > 0 ? std::clamp(((at.x - a.x) * dx + (at.y - a.y) * dy) / squared, 0.0, 1.0) : 0.0;
    return std::hypot(at.x - a.x - t * dx, at.y - a.y - t * dy);
}

/// Returns the distance to the left of the edge, seen along it; y points downwards.
double left_of_px(const PixelPoint& a, const PixelPoint& b, const PixelPoint& at) {
    const double dx = b.x - a.x;
    const double dy = b.y - a.y;
    return ((at.x - a.x) * dy - (at.y - a.y) * dx) / std::hypot(dx, dy);
}

} // namespace

template <typename Coverage>
void Canvas::blend(const PixelBox& box, std::uint32_t rgb, Coverage coverage) {
    const int left = std::max(0, int(std::floor(box.left)));
    const int top = std::max(top_px_, int(std::floor(box.top)));
    const int right = std::min(image_.width, int(std::ceil(box.right)));
    const int bottom = std::min(top_px_ + image_.height, int(std::ceil(box.bottom)));
    for (int y = top; y < bottom; ++y) {
        for (int x = left; x < right; ++x) {
            const double share = std::clamp(coverage(x, y), 0.0, 1.0);
            auto* pixel =
                image_.rgb.data() + (std::size_t(y - top_px_) * image_.width + std::size_t(x)) * 3;
            pixel[0] = mixed(pixel[0], rgb >> 16 & 255U, share);
            pixel[1] = mixed(pixel[1], rgb >> 8 & 255U, share);
            pixel[2] = mixed(pixel[2], rgb & 255U, share);
        }
    }
}

void Canvas::fill(const RoundedBox& shape, std::uint32_t rgb) {
    blend(shape.box, rgb, [&](int x, int y) {
        return 0.5 - outside_px(shape, {x + 0.5, y + 0.5});
    });
}

void Canvas::stroke(const PixelPoint& from,
                    const PixelPoint& to,
                    double radius_px,
                    std::uint32_t rgb) {
    const double reach_px = radius_px + 1;
    const PixelBox box{std::min(from.x, to.x) - reach_px,
                       std::min(from.y, to.y) - reach_px,
                       std::max(from.x, to.x) + reach_px,
                       std::max(from.y, to.y) + reach_px};
    blend(box, rgb, [&](int x, int y) {
        return radius_px + 0.5 - from_piece_px(from, to, {x + 0.5, y + 0.5});
    });
}

void Canvas::fill_triangle(const PixelPoint& a,
                           const PixelPoint& b,
                           const PixelPoint& c,
                           std::uint32_t rgb) {
    const auto [left, right] = std::minmax({a.x, b.x, c.x});
    const auto [top, bottom] = std::minmax({a.y, b.y, c.y});
    blend({left - 1, top - 1, right + 1, bottom + 1}, rgb, [&](int x, int y) {
        const PixelPoint at{x + 0.5, y + 0.5};
        return 0.5 - std::max({left_of_px(a, b, at), left_of_px(b, c, at), left_of_px(c, a, at)});
    });
}

void Canvas::lay(const Image& picture, int left_px, int top_px) {
    const int top = std::max(top_px, top_px_);
    const int bottom = std::min(top_px + picture.height, top_px_ + image_.height);
    const int width = std::min(picture.width, image_.width - left_px);
    for (int y = top; y < bottom; ++y) {
        const auto row = picture.rgb.begin() + std::ptrdiff_t(y - top_px) * picture.width * 3;
        std::copy_n(row,
                    std::ptrdiff_t(width) * 3,
                    image_.rgb.begin() +
                        (std::ptrdiff_t(y - top_px_) * image_.width + left_px) * 3);
    }
}

void Canvas::write(const TextMask& text, const PixelPoint& at, std::uint32_t rgb) {
    const int left = int(std::lround(at.x)) + text.left;
    const int top = int(std::lround(at.y)) + text.top;
    blend({double(left), double(top), double(left + text.width), double(top + text.height)},
          rgb,
          [&](int x, int y) {
              return text.coverage[std::size_t(y - top) * text.width + std::size_t(x - left)] /
                     255.0;
          });
}

} // namespace macadam
