#include "render/map/sheet_shape.hpp"

#include "render/map/map_plan.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double little = 0.25;       // of the sheet empty: the usual shape serves
constexpr double much = 1.0 / 3;      // likewise: details shall fill it
constexpr double most_moderate = 1.5; // longer over shorter side of a sheet for details

bool is_moderate(const PictureSize& size) {
    const auto [less, more] = std::minmax(size.width_px, size.height_px);
    return more <= most_moderate * less + 1;
}

} // namespace

std::vector<PictureSize> other_shapes(const PictureSize& size) {
    const double area_px = double(size.width_px) * size.height_px;
    std::vector<PictureSize> sizes;
    for (const double shape : {1.2, 1.5, 1.0, 1 / 1.2, 1 / 1.5, 2.0, 1 / 2.0, 2.4, 1 / 2.4}) {
        auto& other = sizes.emplace_back(size);
        other.width_px = int(std::lround(std::sqrt(area_px * shape)));
        other.height_px = int(std::lround(std::sqrt(area_px / shape)));
    }
    return sizes;
}

PictureSize size_for(const MapScene& scene,
                     const MapStyle& style,
                     const PictureSize& usual,
                     std::span<const PictureSize> others) {
    if (others.empty()) {
        return usual;
    }
    struct Choice {
        PictureSize size;
        double empty;
    };
    const auto choice = [&](const PictureSize& size) {
        return Choice{size, MapPlan{scene, style, size}.empty_share()};
    };
    auto best = choice(usual);
    auto moderate = best;
    if (best.empty < little) {
        return usual;
    }
    for (const auto& other : others) {
        const auto next = choice(other);
        if (next.empty < best.empty) {
            best = next;
        }
        if (next.empty < moderate.empty && is_moderate(other)) {
            moderate = next;
        }
    }
    return best.empty < much ? best.size : moderate.size;
}

} // namespace macadam
