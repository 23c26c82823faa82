#include "estimator/identification/road_profile.hpp"

#include <algorithm>
#include <cassert>

namespace macadam {
namespace {

/// Returns the slope of the parabola through a station and its two neighbours; at the ends, of the
/// line.
double slope_at(std::span<const double> x, std::span<const double> y, std::size_t i) {
    const auto between = [&](std::size_t a) { return (y[a + 1] - y[a]) / (x[a + 1] - x[a]); };
    if (i == 0 || i + 1 == x.size()) {
        return between(i == 0 ? 0 : i - 1);
    }
    const double before = x[i] - x[i - 1];
    const double after = x[i + 1] - x[i];
    return (after * between(i - 1) + before * between(i)) / (before + after);
}

} // namespace

std::vector<double> elevations_at(std::span<const double> station_m,
                                  std::span<const double> elevation_m,
                                  std::span<const double> at_m) {
    assert(station_m.size() >= 2 && station_m.size() == elevation_m.size());
    std::vector<double> out;
    out.reserve(at_m.size());
    std::size_t i = 0;
    for (const double at : at_m) {
        const double x = std::clamp(at, station_m.front(), station_m.back());
        while (i + 2 < station_m.size() && station_m[i + 1] <= x) {
            ++i;
        }
        const double step = station_m[i + 1] - station_m[i];
        const double t = (x - station_m[i]) / step;
        const double rise = elevation_m[i + 1] - elevation_m[i];
        const double begin = slope_at(station_m, elevation_m, i) * step - rise;
        const double end = rise - slope_at(station_m, elevation_m, i + 1) * step;
        out.push_back(elevation_m[i] + t * rise + t * (1 - t) * ((1 - t) * begin + t * end));
    }
    return out;
}

std::vector<double> mean_of_tracks(const RoadProfile& profile) {
    std::vector<double> mean_m(profile.left_m.size());
    std::ranges::transform(profile.left_m, profile.right_m, mean_m.begin(), [](double l, double r) {
        return (l + r) / 2;
    });
    return mean_m;
}

} // namespace macadam
