#include "mapping/inference/track_lines.hpp"

#include "estimator/common/angle.hpp"
#include "mapping/matching/lattice/observations.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

namespace macadam {
namespace {

using Points = std::vector<PointEn>;

constexpr float standing_mps = 1;        // receiver speed below which positions wander
constexpr float wheels_stand_mps = 0.3F; // wheel speed below which the car stands
constexpr double wheels_near_s = 1;      // validity of a wheel speed
constexpr double stands_s = 20;          // this long within stands_m means 0.6 m/s: not driving
constexpr double stands_m = 12;
constexpr double min_step_s = 0.02;    // faster than any receiver; fixes in between are skipped
constexpr double min_step_share = 0.5; // of the spacing; nearer points are merged
constexpr double widest_kernel = 3;    // standard deviations
constexpr double fastest_mps = 90;     // no car is faster ...
constexpr double jitter_m = 20;        // ... beyond the error of two positions
constexpr double usual_sd_m = 3;       // of a receiver without stated accuracy
constexpr double axis_per_radius = 1 / 1.5; // a 68 % radius is 1.5 sd of one axis (Rayleigh)
constexpr double comes_back_m = 30;         // behind where it stood: the positions wandered

// A car that turned round returns beside its own line; the legs of a hairpin diverge.
constexpr double turned_rad = 150 * rad_per_deg;
constexpr std::size_t turn_points = 3;
constexpr std::size_t leg_points = 8;
constexpr double beside_m = 12;

/// The usable fixes of a trip in the plane, and whether the car stood.
struct Fixes {
    std::vector<GnssFix> fix;
    Points at;
    std::vector<bool> stands;
};

bool wheels_stand(const SpeedSamples& speed, double t_s) {
    const auto after = std::lower_bound(speed.t_s.begin(), speed.t_s.end(), t_s);
    if (after == speed.t_s.end() || *after - t_s > wheels_near_s) {
        return false;
    }
    const auto i = static_cast<std::size_t>(after - speed.t_s.begin());
    return std::abs(speed.speed_mps[i]) < wheels_stand_mps;
}

/// Marks fixes that stay in one position for long.
void mark_clusters(Fixes& fixes) {
    const auto& fix = fixes.fix;
    for (std::size_t i = 0; i < fix.size(); ++i) {
        auto end = i + 1;
        const auto is_near = [&] {
            return end < fix.size() && apart_m(fixes.at[i], fixes.at[end]) < stands_m;
        };
        while (is_near() && fix[end].t_s - fix[i].t_s < stands_s) {
            ++end;
        }
        if (is_near()) {
            std::fill(fixes.stands.begin() + static_cast<std::ptrdiff_t>(i),
                      fixes.stands.begin() + static_cast<std::ptrdiff_t>(end) + 1,
                      true);
        }
    }
}

/// Usable fixes without a jump between them.
struct Part {
    std::vector<GnssFix> fix;
    std::vector<bool> stands;
};

/// Selects the usable fixes of a trip, in parts between which the positions jump.
std::vector<Part> parts_of(const TripLog& trip, const TraceConfig& config) {
    std::vector<Part> parts;
    const auto faults = faults_of(trip.fixes, config.worst_accuracy_m);
    const GnssFix* last = nullptr;
    for (std::size_t i = 0; i < faults.size(); ++i) {
        const auto& fix = trip.fixes[i];
        if (faults[i] || (last != nullptr && fix.t_s - last->t_s < min_step_s)) {
            continue;
        }
        if (last == nullptr || distance_m(last->at, fix.at) > config.longest_step_m) {
            parts.emplace_back();
        }
        parts.back().fix.push_back(fix);
        parts.back().stands.push_back(fix.speed_mps < standing_mps ||
                                      wheels_stand(trip.speed, fix.t_s - trip.meta.gnss_latency_s));
        last = &fix;
    }
    return parts;
}

Fixes in_plane(Part part, const LocalFrame& frame) {
    std::vector<GeoPoint> places;
    for (const auto& fix : part.fix) {
        places.push_back(fix.at);
    }
    Fixes fixes{std::move(part.fix), frame.to_local(places), std::move(part.stands)};
    mark_clusters(fixes);
    return fixes;
}

GeoBox extent_of(const Part& part) {
    GeoBox box;
    for (const auto& fix : part.fix) {
        box = including(box, fix.at);
    }
    return box;
}

/// Returns true if a point extends the line: far enough, and not behind where the car stood.
bool goes_on(const Points& line, const PointEn& at, bool stood, double min_m) {
    if (line.empty()) {
        return true;
    }
    const auto& last = line.back();
    const double step_m = apart_m(last, at);
    if (step_m < min_m) {
        return false;
    }
    if (!stood || line.size() < 2 || step_m > comes_back_m) {
        return true;
    }
    const auto& before = line[line.size() - 2];
    return (at.east_m - last.east_m) * (last.east_m - before.east_m) +
               (at.north_m - last.north_m) * (last.north_m - before.north_m) >
           0;
}

/// Groups positions at least half a spacing apart into runs without gaps or jumps.
std::vector<Points> runs_of(const Fixes& fixes, const TraceConfig& config) {
    std::vector<Points> runs;
    bool stood = false;
    for (std::size_t i = 0; i < fixes.fix.size(); ++i) {
        const double step_s = i == 0 ? 0 : fixes.fix[i].t_s - fixes.fix[i - 1].t_s;
        if (i == 0 || step_s > config.longest_gap_s ||
            apart_m(fixes.at[i - 1], fixes.at[i]) > fastest_mps * step_s + jitter_m) {
            runs.emplace_back();
            stood = false;
        }
        stood = stood || fixes.stands[i];
        if (!fixes.stands[i] &&
            goes_on(runs.back(), fixes.at[i], stood, min_step_share * config.spacing_m)) {
            runs.back().push_back(fixes.at[i]);
            stood = false;
        }
    }
    return runs;
}

/// Returns the root mean square of the receiver's stated accuracy.
double sd_of(const std::vector<Part>& parts) {
    double squares = 0;
    std::size_t count = 0;
    for (const auto& part : parts) {
        for (const auto& fix : part.fix) {
            if (std::isfinite(fix.accuracy_m)) {
                squares += fix.accuracy_m * fix.accuracy_m;
                ++count;
            }
        }
    }
    return count == 0 ? usual_sd_m
                      : std::max(usual_sd_m,
                                 axis_per_radius * std::sqrt(squares / static_cast<double>(count)));
}

std::vector<double> distances_along(const Points& line) {
    std::vector<double> along_m(line.size(), 0.0);
    for (std::size_t i = 1; i < line.size(); ++i) {
        along_m[i] = along_m[i - 1] + apart_m(line[i - 1], line[i]);
    }
    return along_m;
}

/// Sums of a weighted straight-line fit (x: distance from the point in question).
struct Fit {
    double w = 0, wx = 0, wxx = 0, we = 0, wxe = 0, wn = 0, wxn = 0;

    void add(double weight, double x, const PointEn& point) {
        w += weight;
        wx += weight * x;
        wxx += weight * x * x;
        we += weight * point.east_m;
        wxe += weight * x * point.east_m;
        wn += weight * point.north_m;
        wxn += weight * x * point.north_m;
    }
    PointEn at_zero() const {
        const double det = w * wxx - wx * wx;
        if (det <= 1e-9 * w * w) { // one point: no slope
            return {we / w, wn / w};
        }
        return {(wxx * we - wx * wxe) / det, (wxx * wn - wx * wxn) / det};
    }
};

/// Smooths each point by a local straight line through its neighbours within a few sd_m along the
/// line, so that the ends do not move.
Points locally_straight(const Points& line, const std::vector<double>& along_m, double sd_m) {
    Points smooth;
    std::size_t first = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        while (along_m[i] - along_m[first] > widest_kernel * sd_m) {
            ++first;
        }
        Fit fit;
        for (auto k = first; k < line.size() && along_m[k] - along_m[i] <= widest_kernel * sd_m;
             ++k) {
            const double x = along_m[k] - along_m[i];
            fit.add(std::exp(-x * x / (2 * sd_m * sd_m)), x, line[k]);
        }
        smooth.push_back(fit.at_zero());
    }
    return smooth;
}

/// Smooths twice: the residual of the first smoothing is smoothed and added back, so that bends are
/// cut less.
///
/// Source: J. W. Tukey, "Exploratory Data Analysis" (1977): "twicing".
Points smoothed(const Points& line, double sd_m) {
    const auto along_m = distances_along(line);
    auto smooth = locally_straight(line, along_m, sd_m);
    auto rest = line;
    for (std::size_t i = 0; i < line.size(); ++i) {
        rest[i].east_m -= smooth[i].east_m;
        rest[i].north_m -= smooth[i].north_m;
    }
    const auto back = locally_straight(rest, along_m, sd_m);
    for (std::size_t i = 0; i < line.size(); ++i) {
        smooth[i].east_m += back[i].east_m;
        smooth[i].north_m += back[i].north_m;
    }
    return smooth;
}

/// Resamples the line at equal distances, including its last point.
Points resampled(const Points& line, double spacing_m) {
    const auto along_m = distances_along(line);
    const auto steps = std::max(1.0, std::round(along_m.back() / spacing_m));
    Points even{line.front()};
    std::size_t next = 1;
    for (double step = 1; step < steps; ++step) {
        const double at_m = along_m.back() * step / steps;
        while (along_m[next] < at_m) {
            ++next;
        }
        const double share = (at_m - along_m[next - 1]) / (along_m[next] - along_m[next - 1]);
        even.push_back({std::lerp(line[next - 1].east_m, line[next].east_m, share),
                        std::lerp(line[next - 1].north_m, line[next].north_m, share)});
    }
    even.push_back(line.back());
    return even;
}

bool runs_beside(const PointEn& at, std::span<const PointEn> line) {
    return std::ranges::any_of(line, [&](const PointEn& p) { return apart_m(at, p) < beside_m; });
}

/// Returns true if the car turned round at point i: its course is reversed, and the line after the
/// point runs beside the line before it.
bool turns_round(const Points& line, std::size_t i) {
    if (i < turn_points || i + turn_points >= line.size()) {
        return false;
    }
    const auto& a = line[i - turn_points];
    const auto& b = line[i + turn_points];
    const double in_rad = std::atan2(line[i].east_m - a.east_m, line[i].north_m - a.north_m);
    const double out_rad = std::atan2(b.east_m - line[i].east_m, b.north_m - line[i].north_m);
    if (std::abs(std::remainder(out_rad - in_rad, 2 * std::numbers::pi)) < turned_rad) {
        return false;
    }
    const auto first = i - std::min(i, leg_points + turn_points);
    const std::span before{line.data() + first, i - first};
    const auto end = std::min(line.size(), i + leg_points);
    for (auto k = i + turn_points; k < end; ++k) {
        if (!runs_beside(line[k], before)) {
            return false;
        }
    }
    return true;
}

/// Adds a line, cut where the car turned round.
void add_cut(std::vector<TraceLine>& lines, const Points& line, double sd_m) {
    std::size_t first = 0;
    bool after_turn = false;
    const auto add = [&](std::size_t end) {
        if (end - first >= 2) {
            lines.push_back({{line.begin() + static_cast<std::ptrdiff_t>(first),
                              line.begin() + static_cast<std::ptrdiff_t>(end)},
                             sd_m,
                             after_turn});
        }
    };
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (i >= first + turn_points && turns_round(line, i)) {
            add(i + 1);
            first = i + 1;
            after_turn = true;
        }
    }
    add(line.size());
}

std::vector<TraceLine> lines_of(const Fixes& fixes, double sd_m, const TraceConfig& config) {
    std::vector<TraceLine> lines;
    for (const auto& run : runs_of(fixes, config)) {
        if (run.size() < 2) {
            continue;
        }
        const auto smooth = smoothed(run, config.spacing_m);
        if (distances_along(smooth).back() >= config.min_way_m) {
            add_cut(lines, resampled(smooth, config.spacing_m), sd_m);
        }
    }
    return lines;
}

} // namespace

double apart_m(const PointEn& a, const PointEn& b) {
    return std::hypot(b.east_m - a.east_m, b.north_m - a.north_m);
}

double course_rad(const std::vector<PointEn>& line, std::size_t i) {
    const auto& a = line[i == 0 ? 0 : i - 1];
    const auto& b = line[std::min(i + 1, line.size() - 1)];
    return std::atan2(b.east_m - a.east_m, b.north_m - a.north_m);
}

LocalFrame frame_in_middle_of(const GeoBox& box) {
    return is_empty(box) ? LocalFrame{{0, 0}}
                         : LocalFrame{between(
                               {box.south_deg, box.west_deg}, {box.north_deg, box.east_deg}, 0.5)};
}

std::vector<TripDrawing::Line> trace_lines(const TripLog& trip, const TraceConfig& config) {
    auto parts = parts_of(trip, config);
    const double sd_m = sd_of(parts);
    std::vector<TripDrawing::Line> drawn;
    for (auto& part : parts) {
        const auto frame = frame_in_middle_of(extent_of(part));
        for (const auto& line : lines_of(in_plane(std::move(part), frame), sd_m, config)) {
            drawn.push_back({{}, line.sd_m, line.after_turn});
            for (const auto& point : line.points) {
                drawn.back().points.push_back(frame.to_geo(point));
            }
        }
    }
    return drawn;
}

} // namespace macadam
