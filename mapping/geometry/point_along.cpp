#include "mapping/geometry/point_along.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace macadam {

GeoPoint point_along(std::span<const GeoPoint> line, double fraction) {
    assert(!line.empty());
    std::vector<double> measure_m{0};
    for (std::size_t i = 1; i < line.size(); ++i) {
        measure_m.push_back(measure_m.back() + distance_m(line[i - 1], line[i]));
    }
    const double at_m = std::clamp(fraction, 0.0, 1.0) * measure_m.back();
    const auto past = std::ranges::upper_bound(measure_m, at_m);
    if (past == measure_m.end()) {
        return line.back();
    }
    const auto i = static_cast<std::size_t>(past - measure_m.begin());
    return between(
        line[i - 1], line[i], (at_m - measure_m[i - 1]) / (measure_m[i] - measure_m[i - 1]));
}

} // namespace macadam
