#include "mapping/simulation/driven_path.hpp"

#include "mapping/simulation/route.hpp"
#include "mapping/simulation/smoothing.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>

namespace macadam {
namespace {

constexpr double grid_m = 1;
constexpr double sharpest_per_m = 0.5; // no car turns on a radius below 2 m
constexpr double min_step_m = 0.05;    // of travel between points: even a turn on the spot moves
constexpr double corner_cosine = 0.87; // 30 degrees: a sharper bend is a corner
constexpr std::size_t widest_box = 40;
constexpr std::size_t wander_box = 20;

/// A vertex of the map's line along the route, with the properties from there on.
struct Vertex {
    double route_m;
    PointEn at;
    double offset_m; ///< of the lane, to the left
    double usual_mps;
};

GeoPoint middle_of(const RoadNetwork& roads, const std::vector<EdgeId>& route) {
    GeoBox box;
    for (const auto edge : route) {
        for (const auto& point : line_of(roads, edge)) {
            box = including(box, point);
        }
    }
    return {(box.south_deg + box.north_deg) / 2, (box.west_deg + box.east_deg) / 2};
}

std::vector<LanePiece> pieces_of(const RoadNetwork& roads, const std::vector<EdgeId>& route) {
    std::vector<LanePiece> pieces;
    double route_m = 0;
    for (const auto edge : route) {
        const auto link = link_at(roads, edge);
        const Lane lane{link.way, is_forward(edge)};
        const double from_m = whole_mm(link.from_m);
        const double to_m = whole_mm(link.to_m);
        const double station_m = lane.forward ? from_m : lane_length_m(roads, lane) - to_m;
        const double end_m = route_m + (to_m - from_m);
        const bool goes_on =
            !pieces.empty() && pieces.back().lane == lane &&
            std::abs(pieces.back().station_m + (route_m - pieces.back().from_m) - station_m) < 1e-6;
        if (goes_on) {
            pieces.back().to_m = end_m;
        } else {
            pieces.push_back({lane, station_m, route_m, end_m});
        }
        route_m = end_m;
    }
    return pieces;
}

std::vector<Vertex> vertices_of(const RoadNetwork& roads,
                                const std::vector<EdgeId>& route,
                                const DrivingRecipe& driving,
                                const ExactPlane& plane) {
    std::vector<Vertex> vertices;
    double route_m = 0;
    for (const auto edge : route) {
        const auto link = link_at(roads, edge);
        const auto way = way_at(roads, link.way);
        const auto& along_m = way.along_m;
        const double from_m = whole_mm(link.from_m);
        const double to_m = whole_mm(link.to_m);
        const double side = driving.right_hand ? -1 : 1;
        const double offset_m =
            side * (way.oneway == Oneway::no ? driving.lane_offset_m : driving.oneway_offset_m);
        const double usual_mps = usual_speed_kmh(driving, way.highway) / 3.6;
        const auto add = [&](std::uint32_t point) {
            const double at_m = whole_mm(along_m[point]);
            vertices.push_back({route_m + (is_forward(edge) ? at_m - from_m : to_m - at_m),
                                plane.to_plane(way.line[point]),
                                offset_m,
                                usual_mps});
        };
        for (auto i = link.first_point; is_forward(edge) && i <= link.last_point; ++i) {
            add(i);
        }
        for (auto i = link.last_point + 1; !is_forward(edge) && i-- > link.first_point;) {
            add(i);
        }
        route_m += to_m - from_m;
    }
    return vertices;
}

PointEn unit(const PointEn& from, const PointEn& to) {
    const double east_m = to.east_m - from.east_m;
    const double north_m = to.north_m - from.north_m;
    const double length_m = std::sqrt(east_m * east_m + north_m * north_m);
    return length_m > 0 ? PointEn{east_m / length_m, north_m / length_m} : PointEn{1, 0};
}

/// Removes vertices that coincide with the one before: the seams between edges, where the later
/// edge counts.
std::vector<Vertex> without_seams(const std::vector<Vertex>& vertices) {
    std::vector<Vertex> kept;
    for (const auto& vertex : vertices) {
        if (!kept.empty() && vertex.route_m - kept.back().route_m < 1e-6) {
            kept.back().offset_m = vertex.offset_m;
            kept.back().usual_mps = vertex.usual_mps;
        } else {
            kept.push_back(vertex);
        }
    }
    return kept;
}

/// Returns the distance to the nearest corner of the map's line, before or after; at most `max_m`.
std::vector<double>
to_corner_m(const std::vector<Vertex>& vertices, const std::vector<double>& route_m, double max_m) {
    std::vector<double> corners_m;
    for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
        const auto in = unit(vertices[i - 1].at, vertices[i].at);
        const auto out = unit(vertices[i].at, vertices[i + 1].at);
        if (in.east_m * out.east_m + in.north_m * out.north_m < corner_cosine) {
            corners_m.push_back(vertices[i].route_m);
        }
    }
    std::vector<double> distance_m(route_m.size(), max_m);
    for (std::size_t i = 0; i < route_m.size(); ++i) {
        const auto next = std::ranges::lower_bound(corners_m, route_m[i]);
        if (next != corners_m.end()) {
            distance_m[i] = std::min(distance_m[i], *next - route_m[i]);
        }
        if (next != corners_m.begin()) {
            distance_m[i] = std::min(distance_m[i], route_m[i] - *(next - 1));
        }
    }
    return distance_m;
}

std::vector<double> grid_over(double length_m) {
    const auto steps = static_cast<std::size_t>(std::max(2.0, std::round(length_m / grid_m)));
    std::vector<double> grid;
    for (std::size_t i = 0; i <= steps; ++i) {
        grid.push_back(i == steps ? length_m
                                  : length_m * static_cast<double>(i) / static_cast<double>(steps));
    }
    return grid;
}

/// Lines beside the map's, one vector per coordinate, and the width available for rounding corners.
struct LaneLine {
    std::vector<double> east_m;
    std::vector<double> north_m;
    std::vector<std::size_t> box;
};

/// Returns half a box. Three of 17 m turn into the near lane on a radius of 5 m, into the far one
/// on 10 m.
double corner_box(const DrivingRecipe& driving) {
    return std::clamp(std::round((driving.corner_m / grid_m - 1) / 2), 1.0, double{widest_box});
}

LaneLine lane_line(const std::vector<Vertex>& vertices,
                   const std::vector<double>& route_m,
                   const std::vector<double>& wander_m,
                   double min_box) {
    const auto corner_m = to_corner_m(vertices, route_m, widest_box);
    LaneLine line;
    std::size_t at = 0;
    for (std::size_t i = 0; i < route_m.size(); ++i) {
        while (at + 2 < vertices.size() && vertices[at + 1].route_m <= route_m[i]) {
            ++at;
        }
        const auto& a = vertices[at];
        const auto& b = vertices[at + 1];
        const double share =
            std::clamp((route_m[i] - a.route_m) / (b.route_m - a.route_m), 0.0, 1.0);
        const auto ahead = unit(a.at, b.at);
        const double left_m = a.offset_m + wander_m[i];
        line.east_m.push_back(a.at.east_m + share * (b.at.east_m - a.at.east_m) -
                              left_m * ahead.north_m);
        line.north_m.push_back(a.at.north_m + share * (b.at.north_m - a.at.north_m) +
                               left_m * ahead.east_m);
        const double speed_box = (a.usual_mps / 6) * (a.usual_mps / 6); // ~ v^2 / lateral force
        line.box.push_back(
            static_cast<std::size_t>(std::clamp(speed_box, min_box, min_box + corner_m[i])));
    }
    return line;
}

/// Limits the change of box widths along the line.
std::vector<std::size_t> eased(std::vector<std::size_t> box) {
    for (std::size_t i = 1; i < box.size(); ++i) {
        box[i] = std::min(box[i], box[i - 1] + 1);
    }
    for (std::size_t i = box.size(); i-- > 1;) {
        box[i - 1] = std::min(box[i - 1], box[i] + 1);
    }
    return box;
}

std::vector<PointEn> rounded(LaneLine line) {
    const auto box = eased(std::move(line.box));
    for (int i = 0; i < 3; ++i) { // three boxes approximate a Gaussian
        line.east_m = boxed(line.east_m, box);
        line.north_m = boxed(line.north_m, box);
    }
    std::vector<PointEn> points;
    for (std::size_t i = 0; i < line.east_m.size(); ++i) {
        points.push_back({line.east_m[i], line.north_m[i]});
    }
    return points;
}

double length_of(const PointEn& step) {
    return std::sqrt(step.east_m * step.east_m + step.north_m * step.north_m);
}

std::vector<double> travel_along(const ExactPlane& plane, const std::vector<PointEn>& points) {
    std::vector<double> travel_m{0};
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double step_m = length_of(plane.metres(points[i - 1], points[i]));
        travel_m.push_back(travel_m.back() + std::max(step_m, min_step_m));
    }
    return travel_m;
}

/// Computes the curvature of the circle through each point and its neighbours (K. Menger).
std::vector<double> curvature_along(const ExactPlane& plane, const std::vector<PointEn>& points) {
    std::vector<double> curvature_per_m(points.size(), 0.0);
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        const auto in = plane.metres(points[i - 1], points[i]);
        const auto out = plane.metres(points[i], points[i + 1]);
        const auto across = plane.metres(points[i - 1], points[i + 1]);
        const double product = std::max(length_of(in), min_step_m) *
                               std::max(length_of(out), min_step_m) *
                               std::max(length_of(across), min_step_m);
        const double turn = 2 * (in.east_m * out.north_m - in.north_m * out.east_m) / product;
        curvature_per_m[i] = std::clamp(turn, -sharpest_per_m, sharpest_per_m);
    }
    return boxed(curvature_per_m, 1);
}

std::vector<double>
wander_along(std::size_t count, const DrivingRecipe& driving, std::uint64_t seed) {
    auto wander_m = slow_noise(count, driving.wander_m, driving.wander_length_m / grid_m, seed);
    for (int i = 0; i < 3; ++i) {
        wander_m = boxed(wander_m, wander_box);
    }
    return wander_m;
}

} // namespace

DrivenPath driven_path(const RoadNetwork& roads,
                       const std::vector<EdgeId>& route,
                       const DrivingRecipe& driving,
                       std::uint64_t seed) {
    assert(!route.empty());
    DrivenPath path{.plane = ExactPlane{middle_of(roads, route)},
                    .pieces = pieces_of(roads, route),
                    .route_m = {},
                    .travel_m = {},
                    .points = {},
                    .curvature_per_m = {},
                    .wander_m = {}};
    const auto vertices = without_seams(vertices_of(roads, route, driving, path.plane));
    path.route_m = grid_over(path.pieces.back().to_m);
    path.wander_m = wander_along(path.route_m.size(), driving, seed);
    path.points = rounded(lane_line(vertices, path.route_m, path.wander_m, corner_box(driving)));
    path.travel_m = travel_along(path.plane, path.points);
    path.curvature_per_m = curvature_along(path.plane, path.points);
    return path;
}

DrivenPose place_at(const DrivenPath& path, double travel_m) {
    const auto after = std::ranges::upper_bound(path.travel_m, travel_m) - path.travel_m.begin();
    const auto last = static_cast<std::ptrdiff_t>(path.travel_m.size()) - 1;
    const auto b = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(after, 1, last));
    const auto a = b - 1;
    const double share =
        std::clamp((travel_m - path.travel_m[a]) / (path.travel_m[b] - path.travel_m[a]), 0.0, 1.0);
    const auto& p = path.points[a];
    const auto& q = path.points[b];
    return {{p.east_m + share * (q.east_m - p.east_m), p.north_m + share * (q.north_m - p.north_m)},
            unit({0, 0}, path.plane.metres(p, q))};
}

} // namespace macadam
