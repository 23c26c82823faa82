#include "mapping/trace_line.hpp"

#include "mapping/match/positions.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr float standing_mps = 1;        // below it positions wander and the car does not
constexpr double least_step_share = 0.5; // of the spacing; nearer points are one
constexpr double widest_kernel = 3;      // standard deviations
constexpr double fastest_mps = 90;       // more is no car, ...
constexpr double jitter_m = 20;          // ... beyond what two positions are off by

double apart_m(const PointEn& a, const PointEn& b) {
    return std::hypot(b.east_m - a.east_m, b.north_m - a.north_m);
}

/// Positions at least half a spacing apart, in runs without a silence or a jump.
std::vector<TraceLine>
runs_of(const TripLog& trip, const LocalFrame& frame, const TraceConfig& config) {
    std::vector<GnssFix> fixes;
    const auto faults = faults_of(trip.fixes, config.worst_accuracy_m);
    for (std::size_t i = 0; i < faults.size(); ++i) {
        if (!faults[i]) {
            fixes.push_back(trip.fixes[i]);
        }
    }
    std::vector<GeoPoint> places;
    places.reserve(fixes.size());
    for (const auto& fix : fixes) {
        places.push_back(fix.at);
    }
    const auto local = frame.to_local(places);
    std::vector<TraceLine> runs;
    for (std::size_t i = 0; i < fixes.size(); ++i) {
        const double step_s = i == 0 ? 0 : fixes[i].t_s - fixes[i - 1].t_s;
        if (i == 0 || step_s > config.longest_gap_s ||
            apart_m(local[i - 1], local[i]) > fastest_mps * step_s + jitter_m) {
            runs.emplace_back();
        }
        auto& run = runs.back();
        if (fixes[i].speed_mps < standing_mps) {
            continue;
        }
        if (run.empty() || apart_m(run.back(), local[i]) >= least_step_share * config.spacing_m) {
            run.push_back(local[i]);
        }
    }
    return runs;
}

std::vector<double> distances_along(const TraceLine& line) {
    std::vector<double> along_m(line.size(), 0.0);
    for (std::size_t i = 1; i < line.size(); ++i) {
        along_m[i] = along_m[i - 1] + apart_m(line[i - 1], line[i]);
    }
    return along_m;
}

/// Sums of a straight line fitted with weights (x: distance from the point in question).
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

/// Each point from its neighbours within a few sd_m along the line: a local straight line, so that
/// the ends stay where they are.
TraceLine smoothed(const TraceLine& line, double sd_m) {
    const auto along_m = distances_along(line);
    TraceLine smooth;
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

/// Points at even distance along the line, its last point included.
TraceLine resampled(const TraceLine& line, double spacing_m) {
    const auto along_m = distances_along(line);
    const auto steps = std::max(1.0, std::round(along_m.back() / spacing_m));
    TraceLine even{line.front()};
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

} // namespace

std::vector<TraceLine>
trace_lines(const TripLog& trip, const LocalFrame& frame, const TraceConfig& config) {
    std::vector<TraceLine> lines;
    for (const auto& run : runs_of(trip, frame, config)) {
        if (run.size() < 2) {
            continue;
        }
        const auto smooth = smoothed(run, config.spacing_m);
        if (distances_along(smooth).back() >= config.least_way_m) {
            lines.push_back(resampled(smooth, config.spacing_m));
        }
    }
    return lines;
}

} // namespace macadam
