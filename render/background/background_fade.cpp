#include "render/background/background_fade.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace macadam {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Cubic step from 1 to 0, without edges at its ends.
double step_down(double from, double to, double at) {
    if (std::isinf(from)) {
        return 1;
    }
    const double t = std::clamp((at - from) / (to - from), 0.0, 1.0);
    return 1 - t * t * (3 - 2 * t);
}

PixelBox box_of(std::span<const BackgroundShape> shapes) {
    PixelBox box = shapes.front().box;
    for (const auto& shape : shapes) {
        box = {std::min(box.left, shape.box.left),
               std::min(box.top, shape.box.top),
               std::max(box.right, shape.box.right),
               std::max(box.bottom, shape.box.bottom)};
    }
    return box;
}

/// Positions of a side, which grow outwards.
struct Bounds {
    double roads, background, map;
    bool ends_within_map() const { return roads < background && background < map; }
};

BackgroundFade::Side side_of(const Bounds& of, double width_px) {
    constexpr double min_px = 2;
    if (of.ends_within_map()) {
        return {of.roads, of.roads + std::clamp(of.background - of.roads, min_px, width_px)};
    }
    const bool has_room = of.roads < of.background && of.map - of.roads > width_px;
    return has_room ? BackgroundFade::Side{of.roads, of.roads + width_px}
                    : BackgroundFade::Side{infinite, infinite};
}

std::uint8_t mixed(std::uint32_t ground, std::uint8_t above, double share) {
    const double part = ground & 255U;
    return static_cast<std::uint8_t>(std::lround(part + (above - part) * share));
}

} // namespace

double BackgroundFade::share(double x, double y) const {
    return step_down(left.first, left.second, -x) * step_down(right.first, right.second, x) *
           step_down(top.first, top.second, -y) * step_down(bottom.first, bottom.second, y);
}

std::optional<BackgroundFade> background_fade(std::span<const BackgroundShape> shapes,
                                              const PixelBox& roads,
                                              const PixelBox& map,
                                              double width_px) {
    if (shapes.empty()) {
        return {};
    }
    const auto all = box_of(shapes);
    const Bounds left{-roads.left, -all.left, -map.left};
    const Bounds top{-roads.top, -all.top, -map.top};
    const Bounds right{roads.right, all.right, map.right};
    const Bounds bottom{roads.bottom, all.bottom, map.bottom};
    if (!left.ends_within_map() && !top.ends_within_map() && !right.ends_within_map() &&
        !bottom.ends_within_map()) {
        return {};
    }
    return BackgroundFade{.left = side_of(left, width_px),
                          .top = side_of(top, width_px),
                          .right = side_of(right, width_px),
                          .bottom = side_of(bottom, width_px)};
}

void fade(const BackgroundFade& by,
          const PicturePart& part,
          std::uint32_t ground_rgb,
          std::span<std::uint8_t> rgba) {
    std::vector<double> of_column(std::size_t(part.width_px));
    for (std::size_t x = 0; x < of_column.size(); ++x) {
        const double at = part.left_px + double(x) + 0.5;
        of_column[x] = step_down(by.left.first, by.left.second, -at) *
                       step_down(by.right.first, by.right.second, at);
    }
    auto* pixel = rgba.data();
    for (int row = 0; row < part.height_px; ++row) {
        const double at = part.top_px + row + 0.5;
        const double of_row = step_down(by.top.first, by.top.second, -at) *
                              step_down(by.bottom.first, by.bottom.second, at);
        for (const double column : of_column) {
            if (const double share = column * of_row; share < 1) {
                pixel[0] = mixed(ground_rgb >> 16U, pixel[0], share);
                pixel[1] = mixed(ground_rgb >> 8U, pixel[1], share);
                pixel[2] = mixed(ground_rgb, pixel[2], share);
            }
            pixel += 4;
        }
    }
}

} // namespace macadam
