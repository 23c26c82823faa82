#include "mapping/routes/line_matching.hpp"

#include "estimator/common/error.hpp"
#include "estimator/motion/make_odometer.hpp"
#include "estimator/motion/odometer.hpp"
#include "mapping/geometry/nearest_point.hpp"
#include "mapping/passes/segment_overlap.hpp"

#include <algorithm>
#include <limits>

namespace macadam {
namespace {

constexpr double step_m = 5; // between the fixes of the simulated car
constexpr double speed_mps = 5;
constexpr double max_short_m = 30; // end of a line that its match may miss, as at junctions

double length_of(std::span<const GeoPoint> line) {
    double sum_m = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        sum_m += distance_m(line[i - 1], line[i]);
    }
    return sum_m;
}

GnssFix fix_at(const GeoPoint& place, double travel_m) {
    constexpr auto unknown = std::numeric_limits<float>::quiet_NaN();
    return {travel_m / speed_mps, place, unknown, unknown, unknown};
}

/// Simulates a car that drives along the line: a fix at least every 5 m, the last at its end.
TripLog car_along(std::span<const GeoPoint> line) {
    TripLog trip;
    double passed_m = 0, next_m = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        const double piece_m = distance_m(line[i - 1], line[i]);
        for (; next_m < passed_m + piece_m; next_m += step_m) {
            const auto place = between(line[i - 1], line[i], (next_m - passed_m) / piece_m);
            trip.fixes.push_back(fix_at(place, next_m));
        }
        passed_m += piece_m;
    }
    trip.fixes.push_back(fix_at(line.back(), passed_m));
    trip.rows.assign(trip.fixes.size(), row_content::fix);
    return trip;
}

/// Extends a match to its line's own ends: with sparse positions it ends slightly short. Reaches to
/// the nearest point of each end, if that is on the same edge.
LinearRoute
reaching_its_ends(const RoadNetwork& roads, LinearRoute road, std::span<const GeoPoint> line) {
    const auto foot_m = [&](const RouteEdge& part, const GeoPoint& end) {
        return std::min(foot_on(line_of(roads, *part.edge), end).along_m,
                        length_m(roads, *part.edge));
    };
    auto& parts = road.parts;
    if (!parts.empty() && parts.front().edge) {
        const double begin_m = foot_m(parts.front(), line.front());
        if (begin_m < parts.front().from_m && parts.front().from_m - begin_m <= max_short_m) {
            parts.front().from_m = begin_m;
        }
    }
    if (!parts.empty() && parts.back().edge) {
        const double end_m = foot_m(parts.back(), line.back());
        if (end_m > parts.back().to_m && end_m - parts.back().to_m <= max_short_m) {
            parts.back().to_m = end_m;
        }
    }
    return road;
}

MatchedTrace match_of(const RoadNetwork& roads, std::span<const GeoPoint> line) {
    if (line.size() < 2 || !(length_of(line) > 0)) {
        throw InputError{"a line needs two different places"};
    }
    const auto trip = car_along(line);
    const auto odometer = make_odometer(trip, {}).odometer;
    const MatchConfig config{.spacing_m = step_m}; // lines may be as short as one section
    return map_match(trip, odometer, roads, config).trace;
}

} // namespace

LinearRoute matched_line(const RoadNetwork& roads, std::span<const GeoPoint> line) {
    return reaching_its_ends(roads, followed(match_of(roads, line)), line);
}

std::vector<LinePart> line_parts(const RoadNetwork& roads, std::span<const GeoPoint> line) {
    std::vector<LinePart> parts;
    for (const auto& part : driven_parts(match_of(roads, line), roads, 0)) {
        if (part.t_leave_s > part.t_enter_s) {
            parts.push_back({.segment = part.segment,
                             .segment_m = part.segment_m,
                             .from_station_m = part.from_station_m,
                             .to_station_m = part.to_station_m,
                             .from_line_m = part.t_enter_s * speed_mps,
                             .to_line_m = part.t_leave_s * speed_mps,
                             .confidence = part.confidence});
        }
    }
    return parts;
}

} // namespace macadam
