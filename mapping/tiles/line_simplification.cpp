#include "mapping/tiles/line_simplification.hpp"

#include <algorithm>
#include <utility>

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

using Range = std::pair<std::size_t, std::size_t>;

/// Returns the farthest point of a range if it exceeds the tolerance, where the range is split.
std::size_t bend_of(std::span<const WorldPoint> line, const Range& range, double tolerance) {
    std::size_t bend = range.first;
    double farthest = tolerance * tolerance;
    for (auto i = range.first + 1; i < range.second; ++i) {
        const auto distance = distance_squared(line[i], line[range.first], line[range.second]);
        if (distance > farthest) {
            farthest = distance;
            bend = i;
        }
    }
    return bend;
}

} // namespace

std::vector<WorldPoint> simplified(std::span<const WorldPoint> line,
                                   double tolerance,
                                   const std::function<bool(const WorldPoint&)>& is_kept) {
    std::vector<bool> stays(line.size(), false);
    std::vector<Range> open;
    std::size_t begin = 0;
    stays.front() = true;
    for (std::size_t i = 1; i < line.size(); ++i) {
        if (i + 1 == line.size() || is_kept(line[i])) {
            stays[i] = true;
            open.emplace_back(begin, i);
            begin = i;
        }
    }
    while (!open.empty()) { // an explicit stack: a line may have very many points
        const auto range = open.back();
        open.pop_back();
        if (const auto bend = bend_of(line, range, tolerance); bend != range.first) {
            stays[bend] = true;
            open.emplace_back(range.first, bend);
            open.emplace_back(bend, range.second);
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
