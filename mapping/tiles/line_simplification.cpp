#include "mapping/tiles/line_simplification.hpp"

#include "mapping/geometry/line_simplification.hpp"

#include <algorithm>

namespace macadam {
namespace {

/// Returns the squared distance of a position from the straight line between two others.
double distance_squared(const WorldPoint& at, const WorldPoint& from, const WorldPoint& to) {
    const double dx = double(to.x) - from.x, dy = double(to.y) - from.y;
    double x = double(at.x) - from.x, y = double(at.y) - from.y;
    const double length_squared = dx * dx + dy * dy;
    if (length_squared > 0) {
        const double along = std::clamp((x * dx + y * dy) / length_squared, 0.0, 1.0);
        x -= along * dx;
        y -= along * dy;
    }
    return x * x + y * y;
}

} // namespace

std::vector<WorldPoint> simplified(std::span<const WorldPoint> line,
                                   double tolerance,
                                   const std::function<bool(const WorldPoint&)>& is_kept) {
    std::vector<bool> stays(line.size(), false);
    const auto deviation_squared = [&](std::size_t i, std::size_t from, std::size_t to) {
        return distance_squared(line[i], line[from], line[to]);
    };
    std::size_t begin = 0;
    stays.front() = true;
    for (std::size_t i = 1; i < line.size(); ++i) {
        if (i + 1 == line.size() || is_kept(line[i])) {
            stays[i] = true;
            keep_bends(begin, i, tolerance * tolerance, deviation_squared, stays);
            begin = i;
        }
    }
    std::vector<WorldPoint> kept;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (stays[i]) {
            kept.push_back(line[i]);
        }
    }
    return kept;
}

} // namespace macadam
