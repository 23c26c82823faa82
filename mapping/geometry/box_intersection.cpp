#include "mapping/geometry/box_intersection.hpp"

#include "mapping/geometry/antimeridian.hpp"

#include <algorithm>
#include <cstddef>

namespace macadam {
namespace {

/// Tests whether the straight line from `a` to `b` intersects the box (Liang and Barsky's
/// clipping).
bool meets(const GeoBox& box, const GeoPoint& a, const GeoPoint& b) {
    double enter = 0, leave = 1;
    const auto cut = [&](double from, double step, double low, double high) {
        if (step == 0) {
            return low <= from && from <= high;
        }
        const auto [near, far] = std::minmax({(low - from) / step, (high - from) / step});
        enter = std::max(enter, near);
        leave = std::min(leave, far);
        return enter <= leave;
    };
    return cut(a.lon_deg, b.lon_deg - a.lon_deg, box.west_deg, box.east_deg) &&
           cut(a.lat_deg, b.lat_deg - a.lat_deg, box.south_deg, box.north_deg);
}

bool meets(const GeoBox& box, std::span<const GeoPoint> line) {
    if (contains(box, line.front())) { // fast path for most segments
        return true;
    }
    for (std::size_t i = 1; i < line.size(); ++i) {
        if (meets(box, line[i - 1], line[i])) {
            return true;
        }
    }
    return false;
}

} // namespace

bool intersects_any(std::span<const GeoBox> boxes, std::span<const GeoPoint> line) {
    const auto meets_one = [&](std::span<const GeoPoint> part) {
        return std::ranges::any_of(boxes, [&](const GeoBox& box) { return meets(box, part); });
    };
    if (!crosses_antimeridian(line)) {
        return meets_one(line);
    }
    const auto parts = cut_at_antimeridian(line);
    return std::ranges::any_of(parts, meets_one);
}

} // namespace macadam
