#include "mapping/surveys/survey_line.hpp"

#include "estimator/common/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double min_apart_m = 0.01; // closer rows coincide
constexpr double square_m = 100;

/// Gap between neighbouring rows of different lines, in multiples of the usual step.
constexpr double usual_steps = 4;
constexpr double always_joined_m = 15; // of dense surveys, across gaps
constexpr double never_joined_m = 2000;

constexpr double course_over_m = 20; // so that noise of closely spaced rows does not turn the line

double apart_m(const PointEn& a, const PointEn& b) {
    return std::hypot(b.east_m - a.east_m, b.north_m - a.north_m);
}

double longest_leg_m(std::span<const PointEn> points) {
    std::vector<double> steps_m;
    for (std::size_t i = 1; i < points.size(); ++i) {
        steps_m.push_back(apart_m(points[i - 1], points[i]));
    }
    if (steps_m.empty()) {
        return 0;
    }
    return std::clamp(usual_steps * median(std::move(steps_m)), always_joined_m, never_joined_m);
}

/// Returns the point `distance_m` beyond b on the straight line from a.
PointEn beyond(const PointEn& a, const PointEn& b, double distance_m) {
    const double part = distance_m / apart_m(a, b);
    return {b.east_m + part * (b.east_m - a.east_m), b.north_m + part * (b.north_m - a.north_m)};
}

/// Returns the direction of a way around the leg that ends at point i.
PointEn course_at(std::span<const PointEn> way, std::span<const double> way_m, std::size_t i) {
    std::size_t from = i - 1;
    std::size_t to = i;
    while (way_m[to] - way_m[from] < course_over_m && (from > 0 || to + 1 < way.size())) {
        from -= from > 0 ? 1 : 0;
        to += to + 1 < way.size() ? 1 : 0;
    }
    if (apart_m(way[from], way[to]) < min_apart_m) {
        from = i - 1;
        to = i;
    }
    const double chord_m = apart_m(way[from], way[to]);
    return {(way[to].east_m - way[from].east_m) / chord_m,
            (way[to].north_m - way[from].north_m) / chord_m};
}

/// Adds the rows [first, last) of one line, omitting rows that coincide with the one before.
void add_line(std::span<const SurveyRow> survey,
              std::span<const PointEn> points,
              std::size_t first,
              std::size_t last,
              SurveyLines& lines) {
    std::vector<std::size_t> rows{first};
    std::vector<double> station_m{0};
    for (std::size_t row = first + 1; row < last; ++row) {
        const double step_m = apart_m(points[rows.back()], points[row]);
        if (step_m > min_apart_m) {
            rows.push_back(row);
            station_m.push_back(station_m.back() + step_m);
        }
    }
    const std::size_t count = rows.size();
    if (count < 2) {
        return;
    }
    SurveyLine line;
    for (std::size_t i = 0; i < count; ++i) {
        const double before_m = i > 0 ? station_m[i] - station_m[i - 1] : station_m[1];
        const double after_m = i + 1 < count ? station_m[i + 1] - station_m[i] : before_m;
        const auto& length_m = survey[rows[i]].length_m;
        line.pieces.push_back({.row = rows[i],
                               .from_m = station_m[i] - length_m.value_or(before_m) / 2,
                               .to_m = station_m[i] + length_m.value_or(after_m) / 2});
    }
    std::vector<PointEn> way;
    std::vector<double> way_m;
    const auto add = [&](const PointEn& point, double at_m) {
        way.push_back(point);
        way_m.push_back(at_m);
    };
    const auto& front = line.pieces.front();
    const auto& back = line.pieces.back();
    add(beyond(points[rows[1]], points[rows[0]], -front.from_m), front.from_m);
    for (std::size_t i = 0; i < count; ++i) {
        add(points[rows[i]], station_m[i]);
    }
    add(beyond(points[rows[count - 2]], points[rows[count - 1]], back.to_m - station_m.back()),
        back.to_m);
    for (std::size_t i = 1; i < way.size(); ++i) {
        lines.legs.push_back({.begin = way[i - 1],
                              .end = way[i],
                              .line = lines.lines.size(),
                              .begin_m = way_m[i - 1],
                              .course = course_at(way, way_m, i)});
    }
    lines.lines.push_back(std::move(line));
}

std::int32_t square_of(double metres) {
    return static_cast<std::int32_t>(std::clamp(std::floor(metres / square_m), -1e9, 1e9));
}

std::uint64_t key_of(std::int32_t east, std::int32_t north) {
    return (std::uint64_t{static_cast<std::uint32_t>(east)} << 32) |
           static_cast<std::uint32_t>(north);
}

} // namespace

SurveyLines survey_lines(std::span<const SurveyRow> survey, const LocalFrame& frame) {
    std::vector<GeoPoint> places;
    for (const auto& row : survey) {
        places.push_back(row.at);
    }
    const auto points = frame.to_local(places);
    const double longest_m = longest_leg_m(points);
    SurveyLines lines;
    std::size_t first = 0;
    for (std::size_t i = 1; i <= points.size(); ++i) {
        if (i == points.size() || apart_m(points[i - 1], points[i]) > longest_m) {
            add_line(survey, points, first, i, lines);
            first = i;
        }
    }
    return lines;
}

LegPosition nearest_on(const SurveyLeg& leg, const PointEn& point) {
    const double east_m = leg.end.east_m - leg.begin.east_m;
    const double north_m = leg.end.north_m - leg.begin.north_m;
    const double length_m = std::hypot(east_m, north_m);
    const double along_m = ((point.east_m - leg.begin.east_m) * east_m +
                            (point.north_m - leg.begin.north_m) * north_m) /
                           length_m;
    const double at_m = std::clamp(along_m, 0.0, length_m);
    const PointEn foot{leg.begin.east_m + east_m * at_m / length_m,
                       leg.begin.north_m + north_m * at_m / length_m};
    return {.line = leg.line, .station_m = leg.begin_m + at_m, .distance_m = apart_m(foot, point)};
}

SurveyLegIndex::SurveyLegIndex(std::span<const SurveyLeg> legs, double reach_m) {
    for (std::size_t leg = 0; leg < legs.size(); ++leg) {
        const auto& begin = legs[leg].begin;
        const auto& end = legs[leg].end;
        const auto [west_m, east_m] = std::minmax(begin.east_m, end.east_m);
        const auto [south_m, north_m] = std::minmax(begin.north_m, end.north_m);
        for (auto e = square_of(west_m - reach_m); e <= square_of(east_m + reach_m); ++e) {
            for (auto n = square_of(south_m - reach_m); n <= square_of(north_m + reach_m); ++n) {
                squares_[key_of(e, n)].push_back(leg);
            }
        }
    }
}

std::span<const std::size_t> SurveyLegIndex::near(const PointEn& point) const {
    const auto found = squares_.find(key_of(square_of(point.east_m), square_of(point.north_m)));
    return found == squares_.end() ? std::span<const std::size_t>{} : found->second;
}

} // namespace macadam
