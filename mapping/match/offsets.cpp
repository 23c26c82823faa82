#include "mapping/match/offsets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace macadam {
namespace {

constexpr double window_m = 60;       // around where the sample's place puts a position
constexpr double pull = 0.01;         // towards it: decides between the ways there and back
constexpr double alike_m = 300;       // positions this near one another err alike (tens of seconds)
constexpr double least_step_m = 0.05; // a car that moved less tells nothing new
constexpr double odometer_drift = 0.01; // m2 per m: 1 m after 100 m
constexpr double positions_drift = 2;   // m2 per m: travel is itself drawn from positions
constexpr double astray_m = 15;         // off the line by more: hardly believed along it either
constexpr double longest_beyond_m = 40; // of noise beyond the end of a road; more is a hole
constexpr double fade = 5;              // so that places still rise with travel

/// The path's line, its places measured along the path.
std::vector<LinePoint> line_of(const RoadPath& path, const RoadNetwork& roads, RoadPlane& plane) {
    std::vector<LinePoint> line;
    for (const auto& leg : path.legs) {
        const auto link = plane.line(link_of(leg.edge));
        const double edge_m = length_m(roads, leg.edge);
        const bool forward = is_forward(leg.edge);
        const auto offset_m = [&](const LinePoint& point) {
            return forward ? point.along_m : edge_m - point.along_m;
        };
        for (std::size_t i = 0; i + 1 < link.size(); ++i) {
            const auto& a = forward ? link[i] : link[link.size() - 1 - i];
            const auto& b = forward ? link[i + 1] : link[link.size() - 2 - i];
            const double step_m = offset_m(b) - offset_m(a);
            const double from_m = std::max(offset_m(a), leg.from_m);
            const double to_m = std::min(offset_m(b), leg.to_m);
            if (from_m > to_m) {
                continue;
            }
            for (const double at_m : {from_m, to_m}) {
                const double fraction = step_m > 0 ? (at_m - offset_m(a)) / step_m : 0;
                line.push_back({{std::lerp(a.at.east_m, b.at.east_m, fraction),
                                 std::lerp(a.at.north_m, b.at.north_m, fraction)},
                                leg.start_m + at_m - leg.from_m});
            }
        }
    }
    return line;
}

struct Projection {
    double along_m;
    double off_m;
};

Projection project(const std::vector<LinePoint>& line, const PointEn& at, double expected_m) {
    auto step = std::lower_bound(line.begin(),
                                 line.end(),
                                 expected_m - window_m,
                                 [](const auto& p, double along_m) { return p.along_m < along_m; });
    step = step == line.begin() ? step : step - 1;
    Projection best{expected_m, std::numeric_limits<double>::infinity()};
    double least = std::numeric_limits<double>::infinity();
    for (; step + 1 < line.end() && step->along_m <= expected_m + window_m; ++step) {
        const auto& a = *step;
        const auto& b = *(step + 1);
        const double east_m = b.at.east_m - a.at.east_m;
        const double north_m = b.at.north_m - a.at.north_m;
        const double square = east_m * east_m + north_m * north_m;
        const double dot =
            (at.east_m - a.at.east_m) * east_m + (at.north_m - a.at.north_m) * north_m;
        const double fraction = square > 0 ? std::clamp(dot / square, 0.0, 1.0) : 0.0;
        const double along_m = std::lerp(a.along_m, b.along_m, fraction);
        const double off_east_m = a.at.east_m + fraction * east_m - at.east_m;
        const double off_north_m = a.at.north_m + fraction * north_m - at.north_m;
        const double off_square = off_east_m * off_east_m + off_north_m * off_north_m;
        const double away_m = along_m - expected_m;
        if (off_square + pull * away_m * away_m < least) {
            least = off_square + pull * away_m * away_m;
            best = {along_m, std::sqrt(off_square)};
        }
    }
    return best;
}

/// What a position says of (place along the path - travel).
struct Reading {
    double travel_m;
    double lead_m;
    double variance;
};

std::vector<Reading>
readings_of(const RoadPath& path, const std::vector<LinePoint>& line, const Positions& positions) {
    std::vector<Reading> readings;
    std::size_t sample = 0; // the one at or before the position
    for (auto i = path.positions.front(); i <= path.positions.back(); ++i) {
        const auto& position = positions.all[i];
        const double gone_m =
            readings.empty() ? 2 * alike_m : position.travel_m - readings.back().travel_m;
        if (gone_m < least_step_m) {
            continue;
        }
        while (sample + 2 < path.positions.size() && path.positions[sample + 1] <= i) {
            ++sample;
        }
        const auto next = std::min(sample + 1, path.positions.size() - 1);
        const double from_m = positions.all[path.positions[sample]].travel_m;
        const double to_m = positions.all[path.positions[next]].travel_m;
        const double share = to_m > from_m ? (position.travel_m - from_m) / (to_m - from_m) : 0;
        const double expected_m =
            std::lerp(path.sample_m[sample], path.sample_m[next], std::clamp(share, 0.0, 1.0));
        const auto found = project(line, position.at, expected_m);
        const double astray = found.off_m / astray_m;
        const auto sd_m = static_cast<double>(position.own_sd_m);
        readings.push_back(
            {position.travel_m,
             found.along_m - position.travel_m,
             sd_m * sd_m * (1 + astray * astray) * std::max(1.0, 2 * alike_m / gone_m)});
    }
    return readings;
}

struct Belief {
    double mean;
    double variance;
};

std::vector<Belief> smoothed(const std::vector<Reading>& readings, double drift) {
    std::vector<Belief> beliefs;
    for (std::size_t i = 0; i < readings.size(); ++i) {
        const auto& reading = readings[i];
        if (i == 0) {
            beliefs.push_back({reading.lead_m, reading.variance});
            continue;
        }
        const double gone_m = reading.travel_m - readings[i - 1].travel_m;
        const double predicted = beliefs.back().variance + drift * gone_m;
        const double gain = predicted / (predicted + reading.variance);
        const double mean = beliefs.back().mean;
        beliefs.push_back({mean + gain * (reading.lead_m - mean), (1 - gain) * predicted});
    }
    for (auto i = beliefs.size(); i-- > 1;) {
        const double gone_m = readings[i].travel_m - readings[i - 1].travel_m;
        auto& belief = beliefs[i - 1];
        const double gain = belief.variance / (belief.variance + drift * gone_m);
        belief.mean += gain * (beliefs[i].mean - belief.mean);
    }
    return beliefs;
}

/// Noise may put a trip's ends a little beyond the ends of its path: `beyond_m` of it is taken
/// back, all at the end `at_m` and less and less over the way from there.
void pull_in(std::vector<Knot>& knots, double at_m, double beyond_m) {
    if (beyond_m == 0 || std::abs(beyond_m) > longest_beyond_m) {
        return;
    }
    const double fade_m = fade * std::abs(beyond_m);
    for (auto& knot : knots) {
        knot.along_m -= beyond_m * std::max(0.0, 1 - std::abs(knot.travel_m - at_m) / fade_m);
    }
}

} // namespace

std::vector<Knot> smoothed_knots(const RoadPath& path,
                                 const RoadNetwork& roads,
                                 RoadPlane& plane,
                                 const Positions& positions) {
    const auto line = line_of(path, roads, plane);
    const auto readings = readings_of(path, line, positions);
    const auto leads = smoothed(readings, positions.odometer ? odometer_drift : positions_drift);
    std::vector<Knot> knots;
    for (std::size_t i = 0; i < readings.size(); ++i) {
        const double along_m = readings[i].travel_m + leads[i].mean;
        knots.push_back({readings[i].travel_m,
                         knots.empty() ? along_m : std::max(knots.back().along_m, along_m)});
    }
    pull_in(knots, knots.front().travel_m, std::min(0.0, knots.front().along_m));
    pull_in(knots, knots.back().travel_m, std::max(0.0, knots.back().along_m - length_m(path)));
    return knots;
}

} // namespace macadam
