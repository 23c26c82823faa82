#include "mapping/matching/lattice/candidate_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace macadam {
namespace {

constexpr double look_ahead_m = 120; // extra radius of an index query, for the following positions
constexpr double hairpin_m = 25;     // a line that departs this far and returns yields two points

struct OnStep {
    double fraction;
    double distance_m;
};

/// Not std::hypot: coordinates in metres cannot overflow, and this is called for every nearby
/// point.
double apart_m(const PointEn& a, const PointEn& b) {
    const double east_m = b.east_m - a.east_m;
    const double north_m = b.north_m - a.north_m;
    return std::sqrt(east_m * east_m + north_m * north_m);
}

OnStep nearest_on(const PointEn& a, const PointEn& b, const PointEn& at) {
    const double east_m = b.east_m - a.east_m;
    const double north_m = b.north_m - a.north_m;
    const double square = east_m * east_m + north_m * north_m;
    const double along = (at.east_m - a.east_m) * east_m + (at.north_m - a.north_m) * north_m;
    const double fraction = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
    return {fraction, apart_m({a.east_m + fraction * east_m, a.north_m + fraction * north_m}, at)};
}

NearestPoint
place_at(LinkId link, const LinePoint& a, const LinePoint& b, const OnStep& on, const PointEn& at) {
    const double east_m = b.at.east_m - a.at.east_m;
    const double north_m = b.at.north_m - a.at.north_m;
    const double step_m = apart_m(a.at, b.at);
    const double cross = (at.east_m - a.at.east_m) * north_m - (at.north_m - a.at.north_m) * east_m;
    return {link,
            std::lerp(a.along_m, b.along_m, on.fraction),
            on.distance_m,
            std::atan2(east_m, north_m),
            step_m > 0 ? cross / step_m : on.distance_m};
}

/// Adds the points of minimum distance, separated by a rise of at least hairpin_m.
void add_minima(std::vector<NearestPoint>& places,
                LinkId link,
                std::span<const LinePoint> line,
                const PointEn& at,
                double radius_m) {
    constexpr double far_m = std::numeric_limits<double>::infinity();
    OnStep best{0, far_m};
    std::size_t best_step = 0;
    double farthest_since_m = far_m; // a new minimum lies well below it
    const auto add_best = [&] {
        if (best.distance_m <= radius_m) {
            places.push_back(place_at(link, line[best_step], line[best_step + 1], best, at));
        }
        best = {0, far_m};
    };
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const auto on = nearest_on(line[i].at, line[i + 1].at, at);
        const double end_m = apart_m(line[i + 1].at, at);
        if (on.distance_m < best.distance_m && on.distance_m < farthest_since_m - hairpin_m) {
            best = on;
            best_step = i;
        }
        if (best.distance_m < far_m && end_m > best.distance_m + hairpin_m) {
            add_best();
            farthest_since_m = end_m;
        }
        if (best.distance_m == far_m) {
            farthest_since_m = std::max(farthest_since_m, end_m);
        }
    }
    add_best();
}

} // namespace

CandidateIndex::Drawn CandidateIndex::drawn(LinkId link) {
    const auto [found, is_new] = drawn_.try_emplace(static_cast<std::uint32_t>(link));
    if (!is_new) {
        return found->second;
    }
    const auto first_point = packed_link(roads_, edge_of(link, true)).first_point;
    const auto along_m = [&](std::size_t i) {
        return Unpacked{}(roads_.along_mm[first_point + i]);
    };
    const auto line = line_of(roads_, edge_of(link, true));
    auto& drawn = found->second;
    drawn.first = static_cast<std::uint32_t>(points_.size());
    drawn.count = static_cast<std::uint32_t>(line.size());
    const auto local = frame_.to_local(line);
    drawn.low = drawn.high = local.front();
    for (std::size_t i = 0; i < local.size(); ++i) {
        points_.push_back({local[i], along_m(i) - along_m(0)});
        drawn.low = {std::min(drawn.low.east_m, local[i].east_m),
                     std::min(drawn.low.north_m, local[i].north_m)};
        drawn.high = {std::max(drawn.high.east_m, local[i].east_m),
                      std::max(drawn.high.north_m, local[i].north_m)};
    }
    return drawn;
}

std::span<const LinePoint> CandidateIndex::line(LinkId link) {
    const auto there = drawn(link);
    return std::span{points_}.subspan(there.first, there.count);
}

NearestPoint CandidateIndex::nearest(LinkId link, const PointEn& at) {
    const auto points = line(link);
    OnStep best{0, std::numeric_limits<double>::infinity()};
    std::size_t best_step = 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const auto on = nearest_on(points[i].at, points[i + 1].at, at);
        if (on.distance_m < best.distance_m) {
            best = on;
            best_step = i;
        }
    }
    return place_at(link, points[best_step], points[best_step + 1], best, at);
}

void CandidateIndex::look_around(const PointEn& at, const GeoPoint& place, double radius_m) {
    const double moved_m =
        std::hypot(at.east_m - nearby_at_.east_m, at.north_m - nearby_at_.north_m);
    if (moved_m + radius_m <= nearby_radius_m_) {
        return;
    }
    nearby_at_ = at;
    nearby_radius_m_ = radius_m + look_ahead_m;
    nearby_.clear();
    for (const auto link : links_near(roads_, grown(including({}, place), nearby_radius_m_))) {
        nearby_.push_back({link, drawn(link)});
    }
}

std::vector<NearestPoint>
CandidateIndex::near(const PointEn& at, const GeoPoint& place, double radius_m) {
    look_around(at, place, radius_m);
    std::vector<NearestPoint> places;
    for (const auto& [link, there] : nearby_) {
        if (at.east_m < there.low.east_m - radius_m || at.east_m > there.high.east_m + radius_m ||
            at.north_m < there.low.north_m - radius_m ||
            at.north_m > there.high.north_m + radius_m) {
            continue;
        }
        add_minima(
            places, link, std::span{points_}.subspan(there.first, there.count), at, radius_m);
    }
    std::ranges::sort(places, [](const NearestPoint& a, const NearestPoint& b) {
        return std::tie(a.distance_m, a.link, a.along_m) <
               std::tie(b.distance_m, b.link, b.along_m);
    });
    return places;
}

} // namespace macadam
