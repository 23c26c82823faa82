#include "mapping/analysis/exclusion.hpp"

#include "mapping/geometry/nearest_point.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double step_m = 1;

GeoBox box_of(std::span<const GeoPoint> line) {
    GeoBox box;
    for (const auto& point : line) {
        box = including(box, point);
    }
    return box;
}

bool overlap(const GeoBox& a, const GeoBox& b) {
    return a.west_deg <= b.east_deg && b.west_deg <= a.east_deg && a.south_deg <= b.north_deg &&
           b.south_deg <= a.north_deg;
}

struct BoxedExclusion {
    const Exclusion* exclusion;
    GeoBox box; ///< enlarged by the radius
};

/// Appends the steps of a part that lie within an exclusion to ranges that end before it.
void add_excluded(std::vector<RouteMeasureRange>& ranges,
                  const RoadNetwork& roads,
                  const RouteEdge& part,
                  double start_m,
                  std::span<const BoxedExclusion> near) {
    const double whole_m = part.to_m - part.from_m;
    const auto steps = static_cast<std::size_t>(std::max(1.0, std::ceil(whole_m / step_m)));
    for (std::size_t i = 0; i < steps; ++i) {
        const double from_m = whole_m * static_cast<double>(i) / static_cast<double>(steps);
        const double to_m = whole_m * static_cast<double>(i + 1) / static_cast<double>(steps);
        const auto place = place_on(roads, *part.edge, part.from_m + (from_m + to_m) / 2);
        const bool excluded = std::ranges::any_of(near, [&](const BoxedExclusion& placed) {
            return contains(placed.box, place) &&
                   foot_on(placed.exclusion->line, place).distance_m <= placed.exclusion->radius_m;
        });
        if (!excluded) {
            continue;
        }
        if (!ranges.empty() && ranges.back().to_m >= start_m + from_m - step_m / 2) {
            ranges.back().to_m = start_m + to_m;
        } else {
            ranges.push_back({start_m + from_m, start_m + to_m});
        }
    }
}

} // namespace

std::vector<RouteMeasureRange> excluded_ranges(const RoadNetwork& roads,
                                               const LinearRoute& road,
                                               std::span<const Exclusion> exclusions) {
    std::vector<BoxedExclusion> placed;
    for (const auto& exclusion : exclusions) {
        placed.push_back({&exclusion, grown(box_of(exclusion.line), exclusion.radius_m)});
    }
    std::vector<RouteMeasureRange> ranges;
    double start_m = 0;
    for (const auto& part : road.parts) {
        if (part.edge) {
            const auto box = box_of(line_on(roads, *part.edge, part.from_m, part.to_m));
            std::vector<BoxedExclusion> near;
            std::ranges::copy_if(placed, std::back_inserter(near), [&](const auto& exclusion) {
                return overlap(exclusion.box, box);
            });
            if (!near.empty()) {
                add_excluded(ranges, roads, part, start_m, near);
            }
        }
        start_m += part.to_m - part.from_m;
    }
    return ranges;
}

} // namespace macadam
