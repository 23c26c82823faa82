#include "mapping/match/driven_line.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace macadam {
namespace {

constexpr double about_step_m = 2;
// Three boxes of 17 m: a right-angled corner becomes a bend of 5 m radius in the near lane and of
// 10 m in the far one, as drivers take them.
constexpr std::size_t box_half = 4; // steps
constexpr double least_step_m =
    0.02; // where the car turns round on the spot, the line still goes on

struct Corner {
    PointEn at;
    double along_m;
    LaneKind lane; ///< from here on
};

/// The path's line, its places measured along the path.
std::vector<Corner> corners_of(const RoadPath& path, const RoadNetwork& roads, RoadPlane& plane) {
    std::vector<Corner> line;
    for (const auto& leg : path.legs) {
        const auto link = plane.line(link_of(leg.edge));
        const double edge_m = length_m(roads, leg.edge);
        const bool forward = is_forward(leg.edge);
        const auto lane = is_drivable(roads, leg.edge) && is_drivable(roads, reversed(leg.edge))
                              ? LaneKind::two_way
                              : LaneKind::oneway;
        const auto offset_m = [&](const LinePoint& point) {
            return forward ? point.along_m : edge_m - point.along_m;
        };
        for (std::size_t i = 0; i + 1 < link.size(); ++i) {
            const auto& a = forward ? link[i] : link[link.size() - 1 - i];
            const auto& b = forward ? link[i + 1] : link[link.size() - 2 - i];
            const double piece_m = offset_m(b) - offset_m(a);
            const double from_m = std::max(offset_m(a), leg.from_m);
            const double to_m = std::min(offset_m(b), leg.to_m);
            if (from_m > to_m) {
                continue;
            }
            for (const double at_m : {from_m, to_m}) {
                const double fraction = piece_m > 0 ? (at_m - offset_m(a)) / piece_m : 0;
                line.push_back({{std::lerp(a.at.east_m, b.at.east_m, fraction),
                                 std::lerp(a.at.north_m, b.at.north_m, fraction)},
                                leg.start_m + at_m - leg.from_m,
                                lane});
            }
        }
    }
    return line;
}

/// At even steps from end to end.
DrivenLine evened(const std::vector<Corner>& corners) {
    const double whole_m = corners.back().along_m;
    const auto steps = static_cast<std::size_t>(std::max(1.0, std::round(whole_m / about_step_m)));
    const double step_m = whole_m / static_cast<double>(steps);
    DrivenLine line{step_m, {}, {}, {}, {}, {}, {}};
    std::size_t next = 1;
    const auto count = steps + 1;
    line.at.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double along_m = step_m * static_cast<double>(i);
        while (next + 1 < corners.size() && corners[next].along_m < along_m) {
            ++next;
        }
        const auto& a = corners[next - 1];
        const auto& b = corners[next];
        const double piece_m = b.along_m - a.along_m;
        const double share =
            piece_m > 0 ? std::clamp((along_m - a.along_m) / piece_m, 0.0, 1.0) : 0;
        line.at.push_back({std::lerp(a.at.east_m, b.at.east_m, share),
                           std::lerp(a.at.north_m, b.at.north_m, share)});
        line.lane.push_back(a.lane);
    }
    return line;
}

/// Means over box_half points on both sides, over as many as there are on both near the ends.
std::vector<PointEn> boxed(const std::vector<PointEn>& points) {
    std::vector<PointEn> sums{{0, 0}};
    sums.reserve(points.size() + 1);
    for (const auto& p : points) {
        sums.push_back({sums.back().east_m + p.east_m, sums.back().north_m + p.north_m});
    }
    std::vector<PointEn> means;
    means.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto half = std::min({box_half, i, points.size() - 1 - i});
        const auto& low = sums[i - half];
        const auto& high = sums[i + half + 1];
        const auto n = static_cast<double>(2 * half + 1);
        means.push_back({(high.east_m - low.east_m) / n, (high.north_m - low.north_m) / n});
    }
    return means;
}

DrivenLine measured(DrivenLine line) {
    const auto count = line.at.size();
    line.driven_m.assign(count, 0);
    line.heading_rad.assign(count, 0);
    line.heading_sum.assign(count, 0);
    line.turned_rad.assign(count, {0, 0});
    for (std::size_t i = 0; i < count; ++i) {
        const auto& before = line.at[i > 0 ? i - 1 : 0];
        const auto& after = line.at[std::min(i + 1, count - 1)];
        const double east_m = after.east_m - before.east_m;
        const double north_m = after.north_m - before.north_m;
        const double rad = std::atan2(north_m, east_m);
        if (i == 0) {
            line.heading_rad[0] = rad;
            continue;
        }
        const double turn_rad = std::remainder(rad - line.heading_rad[i - 1], 2 * std::numbers::pi);
        line.heading_rad[i] = line.heading_rad[i - 1] + turn_rad;
        const double gone_m = std::max(
            least_step_m,
            std::hypot(line.at[i].east_m - before.east_m, line.at[i].north_m - before.north_m));
        line.driven_m[i] = line.driven_m[i - 1] + gone_m;
        line.heading_sum[i] =
            line.heading_sum[i - 1] + gone_m * (line.heading_rad[i - 1] + line.heading_rad[i]) / 2;
        line.turned_rad[i] = line.turned_rad[i - 1];
        line.turned_rad[i][static_cast<std::size_t>(line.lane[i])] += turn_rad;
    }
    return line;
}

/// The piece of the line that holds a place, the outermost for one beyond.
std::size_t piece_at(const DrivenLine& line, double driven_m) {
    const auto next = std::ranges::upper_bound(line.driven_m, driven_m) - line.driven_m.begin();
    return std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(next, 1)) - 1,
                    line.driven_m.size() - 2);
}

/// Sum of the heading up to a place.
double heading_sum_at(const DrivenLine& line, double driven_m) {
    const auto i = piece_at(line, driven_m);
    const double piece_m = line.driven_m[i + 1] - line.driven_m[i];
    const double into_m = driven_m - line.driven_m[i];
    const double inside_m = std::clamp(into_m, 0.0, piece_m);
    const double turn_rad = line.heading_rad[i + 1] - line.heading_rad[i];
    const double beyond_rad = into_m > 0 ? line.heading_rad[i + 1] : line.heading_rad[i];
    return line.heading_sum[i] +
           inside_m * (line.heading_rad[i] + inside_m / piece_m * turn_rad / 2) +
           (into_m - inside_m) * beyond_rad;
}

} // namespace

DrivenLine driven_line(const RoadPath& path, const RoadNetwork& roads, RoadPlane& plane) {
    const auto corners = corners_of(path, roads, plane);
    if (corners.size() < 2 || corners.back().along_m < about_step_m / 2) {
        return {about_step_m, {}, {}, {}, {}, {}, {}};
    }
    auto line = evened(corners);
    for (int i = 0; i < 3; ++i) { // three boxes are nearly a bell
        line.at = boxed(line.at);
    }
    return measured(std::move(line));
}

DrivenPlace place_at(const DrivenLine& line, double driven_m) {
    const auto i = piece_at(line, driven_m);
    const double piece_m = line.driven_m[i + 1] - line.driven_m[i];
    const double into_m = driven_m - line.driven_m[i];
    const double share = std::clamp(into_m / piece_m, 0.0, 1.0);
    const double beyond_m = into_m - share * piece_m; // 0 but at the ends
    const double heading_rad = std::lerp(line.heading_rad[i], line.heading_rad[i + 1], share);
    const PointEn ahead{std::cos(heading_rad), std::sin(heading_rad)};
    const auto between = [&](const PointEn& a, const PointEn& b) {
        return PointEn{std::lerp(a.east_m, b.east_m, share) + beyond_m * ahead.east_m,
                       std::lerp(a.north_m, b.north_m, share) + beyond_m * ahead.north_m};
    };
    const auto turned_rad = [&](std::size_t kind) {
        return std::lerp(line.turned_rad[i][kind], line.turned_rad[i + 1][kind], share);
    };
    return {between(line.at[i], line.at[i + 1]),
            ahead,
            line.step_m * (static_cast<double>(i) + share) + beyond_m,
            line.lane[i],
            {turned_rad(0), turned_rad(1)}};
}

double driven_m_at(const DrivenLine& line, double along_m) {
    const double end_m = line.step_m * static_cast<double>(line.driven_m.size() - 1);
    const double steps = std::clamp(along_m, 0.0, end_m) / line.step_m;
    const auto i = std::min(static_cast<std::size_t>(steps), line.driven_m.size() - 2);
    return std::lerp(line.driven_m[i], line.driven_m[i + 1], steps - static_cast<double>(i)) +
           std::min(along_m, 0.0) + std::max(along_m - end_m, 0.0);
}

double mean_heading_rad(const DrivenLine& line, double driven_m, double half_m) {
    return (heading_sum_at(line, driven_m + half_m) - heading_sum_at(line, driven_m - half_m)) /
           (2 * half_m);
}

} // namespace macadam
