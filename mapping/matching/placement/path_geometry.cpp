#include "mapping/matching/placement/path_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace macadam {
namespace {

constexpr double about_step_m = 2;
// Three boxes of 17 m turn a right-angled corner into a bend of 5 m radius in the near lane and of
// 10 m in the far one, as driven.
constexpr std::size_t box_half = 4; // steps
constexpr double min_step_m = 0.02; // per step; the line advances even in a turn on the spot

/// Not std::lerp, whose handling of infinities costs more than everything else.
double between(double a, double b, double share) {
    return a + share * (b - a);
}

PointEn between(const PointEn& a, const PointEn& b, double share) {
    return {between(a.east_m, b.east_m, share), between(a.north_m, b.north_m, share)};
}

struct Corner {
    PointEn at;
    double along_m;
    LaneKind lane; ///< from here on
};

/// Returns the path's line with positions measured along the path.
std::vector<Corner>
corners_of(const RoadPath& path, const RoadNetwork& roads, CandidateIndex& plane) {
    std::vector<Corner> line;
    for (const auto& interval : path.intervals) {
        const auto link = plane.line(link_of(interval.edge));
        const double edge_m = length_m(roads, interval.edge);
        const bool forward = is_forward(interval.edge);
        const auto lane =
            is_drivable(roads, interval.edge) && is_drivable(roads, reversed(interval.edge))
                ? LaneKind::two_way
                : LaneKind::oneway;
        const auto offset_m = [&](const LinePoint& point) {
            return forward ? point.along_m : edge_m - point.along_m;
        };
        for (std::size_t i = 0; i + 1 < link.size(); ++i) {
            const auto& a = forward ? link[i] : link[link.size() - 1 - i];
            const auto& b = forward ? link[i + 1] : link[link.size() - 2 - i];
            const double piece_m = offset_m(b) - offset_m(a);
            const double from_m = std::max(offset_m(a), interval.from_m);
            const double to_m = std::min(offset_m(b), interval.to_m);
            if (from_m > to_m) {
                continue;
            }
            for (const double at_m : {from_m, to_m}) {
                const double fraction = piece_m > 0 ? (at_m - offset_m(a)) / piece_m : 0;
                line.push_back({between(a.at, b.at, fraction),
                                interval.start_m + at_m - interval.from_m,
                                lane});
            }
        }
    }
    return line;
}

/// Resamples at equal steps from end to end.
SmoothedPath evened(const std::vector<Corner>& corners) {
    const double whole_m = corners.back().along_m;
    const auto steps = static_cast<std::size_t>(std::max(1.0, std::round(whole_m / about_step_m)));
    const double step_m = whole_m / static_cast<double>(steps);
    SmoothedPath line{step_m, {}, {}, {}, {}, {}, {}, {}};
    std::size_t next = 1;
    const auto count = steps + 1;
    line.at.reserve(count);
    line.lane.reserve(count);
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
        line.at.push_back(between(a.at, b.at, share));
        line.lane.push_back(a.lane);
    }
    return line;
}

/// Averages over box_half points on both sides; the window shrinks symmetrically near the ends.
std::vector<PointEn> boxed(const std::vector<PointEn>& points) {
    std::vector<PointEn> sums(points.size() + 1, {0, 0});
    for (std::size_t i = 0; i < points.size(); ++i) {
        sums[i + 1] = {sums[i].east_m + points[i].east_m, sums[i].north_m + points[i].north_m};
    }
    std::vector<PointEn> means(points.size());
    const auto mean = [&](std::size_t i, std::size_t half) {
        const auto& low = sums[i - half];
        const auto& high = sums[i + half + 1];
        const double share = 1 / static_cast<double>(2 * half + 1);
        return PointEn{(high.east_m - low.east_m) * share, (high.north_m - low.north_m) * share};
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        means[i] = mean(i, std::min({box_half, i, points.size() - 1 - i}));
    }
    return means;
}

/// Angle from one direction to another, positive to the left.
double turn_between(const PointEn& from, const PointEn& to) {
    constexpr double slight = 1e-3;
    const double along = from.east_m * to.east_m + from.north_m * to.north_m;
    const double across = from.east_m * to.north_m - from.north_m * to.east_m;
    if (std::abs(across) < slight * along) { // nearly always; the series is exact to the last bit
        const double tan = across / along;
        const double square = tan * tan;
        return tan * (1 - square * (1.0 / 3 - square * (1.0 / 5 - square / 7)));
    }
    const bool back = along < 0 && std::abs(across) < -slight * slight * along;
    return back ? std::numbers::pi
                : std::atan2(across, along); // turning on the spot counts as left
}

/// Returns for each step of driven length the line segment that contains its start.
std::vector<std::uint32_t> first_pieces(const SmoothedPath& line) {
    std::vector<std::uint32_t> pieces;
    pieces.reserve(line.driven_m.size());
    std::uint32_t piece = 0;
    for (double at_m = 0; at_m < line.driven_m.back();
         at_m = line.step_m * static_cast<double>(pieces.size())) {
        while (piece + 2 < line.driven_m.size() && line.driven_m[piece + 1] <= at_m) {
            ++piece;
        }
        pieces.push_back(piece);
    }
    return pieces;
}

SmoothedPath measured(SmoothedPath line) {
    const auto count = line.at.size();
    line.driven_m.resize(count);
    line.heading_rad.resize(count);
    line.heading_sum.resize(count);
    line.turned_rad.resize(count);
    const auto step = [&](std::size_t from, std::size_t to) {
        return PointEn{line.at[to].east_m - line.at[from].east_m,
                       line.at[to].north_m - line.at[from].north_m};
    };
    auto before = step(0, 1);
    line.heading_rad[0] = std::atan2(before.north_m, before.east_m);
    for (std::size_t i = 1; i < count; ++i) {
        const auto ahead = step(i - 1, std::min(i + 1, count - 1));
        const double turn_rad = turn_between(before, ahead);
        const bool stands = ahead.east_m == 0 && ahead.north_m == 0;
        before = stands ? before : ahead;
        const auto gone = step(i - 1, i);
        const double gone_m = std::max(
            min_step_m, std::sqrt(gone.east_m * gone.east_m + gone.north_m * gone.north_m));
        line.heading_rad[i] = line.heading_rad[i - 1] + turn_rad;
        line.driven_m[i] = line.driven_m[i - 1] + gone_m;
        line.heading_sum[i] =
            line.heading_sum[i - 1] + gone_m * (line.heading_rad[i - 1] + line.heading_rad[i]) / 2;
        line.turned_rad[i] = line.turned_rad[i - 1];
        line.turned_rad[i][static_cast<std::size_t>(line.lane[i])] += turn_rad;
    }
    line.first_piece = first_pieces(line);
    return line;
}

/// Returns the line segment that contains a position, clamped to the first and last.
std::size_t piece_at(const SmoothedPath& line, double driven_m) {
    const double steps = std::max(0.0, driven_m / line.step_m);
    const auto last = static_cast<double>(line.first_piece.size() - 1);
    std::size_t i = line.first_piece[static_cast<std::size_t>(std::min(steps, last))];
    while (i + 2 < line.driven_m.size() && line.driven_m[i + 1] <= driven_m) {
        ++i;
    }
    return i;
}

/// Relative position within a line segment, and the distance beyond the line, which is 0 except at
/// the ends.
struct Share {
    double share;
    double beyond_m;
};

Share share_of(const SmoothedPath& line, std::size_t piece, double driven_m) {
    const double piece_m = line.driven_m[piece + 1] - line.driven_m[piece];
    const double into_m = driven_m - line.driven_m[piece];
    const double share = std::clamp(into_m / piece_m, 0.0, 1.0);
    return {share, share > 0 && share < 1 ? 0 : into_m - share * piece_m};
}

/// Integrates the heading up to a position.
double heading_sum_at(const SmoothedPath& line, double driven_m) {
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

SmoothedPath driven_line(const RoadPath& path, const RoadNetwork& roads, CandidateIndex& plane) {
    const auto corners = corners_of(path, roads, plane);
    if (corners.size() < 2 || corners.back().along_m < about_step_m / 2) {
        return {about_step_m, {}, {}, {}, {}, {}, {}, {}};
    }
    auto line = evened(corners);
    for (int i = 0; i < 3; ++i) { // three boxes approximate a Gaussian
        line.at = boxed(line.at);
    }
    return measured(std::move(line));
}

PathPose place_at(const SmoothedPath& line, double driven_m) {
    const auto i = piece_at(line, driven_m);
    const auto [share, beyond_m] = share_of(line, i, driven_m);
    const double heading_rad = between(line.heading_rad[i], line.heading_rad[i + 1], share);
    const PointEn ahead{std::cos(heading_rad), std::sin(heading_rad)};
    const auto at = between(line.at[i], line.at[i + 1], share);
    const auto& before_rad = line.turned_rad[i];
    const auto& after_rad = line.turned_rad[i + 1];
    return {
        {at.east_m + beyond_m * ahead.east_m, at.north_m + beyond_m * ahead.north_m},
        ahead,
        line.lane[i],
        {between(before_rad[0], after_rad[0], share), between(before_rad[1], after_rad[1], share)}};
}

double along_m_at(const SmoothedPath& line, double driven_m) {
    const auto i = piece_at(line, driven_m);
    const auto [share, beyond_m] = share_of(line, i, driven_m);
    return line.step_m * (static_cast<double>(i) + share) + beyond_m;
}

double driven_m_at(const SmoothedPath& line, double along_m) {
    const double end_m = line.step_m * static_cast<double>(line.driven_m.size() - 1);
    const double steps = std::clamp(along_m, 0.0, end_m) / line.step_m;
    const auto i = std::min(static_cast<std::size_t>(steps), line.driven_m.size() - 2);
    return std::lerp(line.driven_m[i], line.driven_m[i + 1], steps - static_cast<double>(i)) +
           std::min(along_m, 0.0) + std::max(along_m - end_m, 0.0);
}

double mean_heading_rad(const SmoothedPath& line, double driven_m, double half_m) {
    return (heading_sum_at(line, driven_m + half_m) - heading_sum_at(line, driven_m - half_m)) /
           (2 * half_m);
}

} // namespace macadam
