#include "mapping/passes/track_difference.hpp"

#include "estimator/iri/iri.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace macadam {
namespace {

constexpr double window_m = 20;         // of the fit, and the shortest interval with a ratio
constexpr std::size_t min_windows = 50; // a kilometre

// Part of the observed variation of r² that is the road's: slope of true on observed values over 20
// m, 0.55 in one simulated world and 0.94 in another (docs/method/accuracy.md).
constexpr double road_part = 0.6;

// Part of the distance from the usual ratio at which a trip's tracks, drawn from the posterior,
// show theirs: they do so to 0.018 (docs/method/accuracy.md).
constexpr double trip_part = 2.0 / 3;

// Scatter of true ratios about those found so, over 20 m: 0.037 and 0.041 in these worlds, and of
// the mean over a trip.
constexpr double sd_of_found_ratio = 0.045;

constexpr double max_excess = 2.5; // of r² over its usual value; more is a bend, not the road

// Fit of the level over the trip.
constexpr double degrees = 4;       // of Student's t
constexpr double scatter = 0.6;     // relative, of half² over one window
constexpr double min_spread = 1e-6; // relative, of HRI²: below, noise cannot be told from the road
constexpr int rounds = 20;
constexpr double elasticity = 0.1; // of a trip's mean MRI over the level, about; steps stay below 1

/// Mean HRI and difference over a range of travel past the lead-ins.
struct Strength {
    double covered_m = 0;
    double centre = 0;
    double half = 0;
};

void add(const DifferenceRun& run, double from_m, double to_m, Strength& sum) {
    const double begin_m = std::max(from_m, run.start_travel_m + run.lead_in_m);
    const auto cells = static_cast<double>(run.half_mm_per_m.size());
    const double first = std::ceil((begin_m - run.start_travel_m) / run.cell_m - 0.5);
    const double last = std::min(cells, (to_m - run.start_travel_m) / run.cell_m - 0.5);
    for (double cell = std::max(0.0, first); cell < last; ++cell) {
        const auto i = static_cast<std::size_t>(cell);
        sum.covered_m += run.cell_m;
        sum.centre += run.cell_m * static_cast<double>(run.centre_mm_per_m[i]);
        sum.half += run.cell_m * static_cast<double>(run.half_mm_per_m[i]);
    }
}

std::optional<DifferenceRun> difference_of(const IriRun& run) {
    const auto& left_m = run.profile.left_m;
    const auto& right_m = run.profile.right_m;
    if (left_m.size() < 2 || left_m.size() != right_m.size()) {
        return std::nullopt;
    }
    std::vector<double> half_m(left_m.size());
    for (std::size_t i = 0; i < half_m.size(); ++i) {
        half_m[i] = (static_cast<double>(left_m[i]) - static_cast<double>(right_m[i])) / 2;
    }
    DifferenceRun difference{.start_travel_m = run.profile.start_travel_m,
                             .cell_m = run.profile.step_m,
                             .lead_in_m = run.lead_in_m,
                             .centre_mm_per_m = run.centre_mm_per_m,
                             .half_mm_per_m =
                                 rectified_stroke_mm_per_m(half_m, run.profile.step_m, false)};
    const std::size_t cells =
        std::min(difference.centre_mm_per_m.size(), difference.half_mm_per_m.size());
    difference.centre_mm_per_m.resize(cells);
    difference.half_mm_per_m.resize(cells);
    return difference;
}

/// Returns the sum of the golden car's strokes over the cells from the first one on.
double stroke_sum(const std::vector<double>& elevation_m, double step_m, std::size_t first) {
    const auto strokes = rectified_stroke_mm_per_m(elevation_m, step_m, false);
    return std::accumulate(strokes.begin() +
                               static_cast<std::ptrdiff_t>(std::min(first, strokes.size())),
                           strokes.end(),
                           0.0);
}

/// Returns HRI/MRI of the whole trip over tracks drawn from the posterior, two of each run: the
/// most probable ones lack what was not observed of their difference. The trip has tracks.
double drawn_ratio(const IriTrace& trace) {
    double hri = 0;
    double mri = 0;
    for (const auto& run : trace.runs) {
        const auto& profile = run.profile;
        const auto first = static_cast<std::size_t>(run.lead_in_m / run.cell_m);
        if (profile.left_m.size() != profile.right_m.size() ||
            profile.left_error_m.size() != profile.left_m.size() ||
            profile.right_error_m.size() != profile.left_m.size()) {
            continue;
        }
        for (const double sign : {+1.0, -1.0}) {
            std::vector<double> left_m(profile.left_m.size());
            std::vector<double> right_m(profile.left_m.size());
            std::vector<double> centre_m(profile.left_m.size());
            for (std::size_t i = 0; i < left_m.size(); ++i) {
                left_m[i] = static_cast<double>(profile.left_m[i]) +
                            sign * static_cast<double>(profile.left_error_m[i]);
                right_m[i] = static_cast<double>(profile.right_m[i]) +
                             sign * static_cast<double>(profile.right_error_m[i]);
                centre_m[i] = (left_m[i] + right_m[i]) / 2;
            }
            hri += stroke_sum(centre_m, profile.step_m, first);
            mri += (stroke_sum(left_m, profile.step_m, first) +
                    stroke_sum(right_m, profile.step_m, first)) /
                   2;
        }
    }
    return mri > 0 ? hri / mri : hri_over_mri;
}

/// half² as a function of HRI².
struct Level {
    double gain = 0;
    double noise_mm2 = 0;

    double at(double hri2) const { return gain * hri2 + noise_mm2; }
};

/// HRI/MRI where half² exceeds its level by this factor, in a trip of this mean ratio.
double ratio_at(double excess, double trip_ratio) {
    const double r2 = 1 / (trip_ratio * trip_ratio) - 1;
    return 1 / std::sqrt(1 + r2 * (1 + road_part * (excess - 1)));
}

/// Squares over one window.
struct Squares {
    double hri2;
    double half2;
};

double median_ratio(const std::vector<Squares>& windows) {
    std::vector<double> ratios(windows.size());
    std::ranges::transform(
        windows, ratios.begin(), [](const Squares& w) { return w.half2 / w.hri2; });
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::ranges::nth_element(ratios, middle);
    return *middle;
}

/// Solves one round of weighted least squares, with noise of at least 0.
Level refitted(const std::vector<Squares>& windows, const Level& old) {
    double w = 0;
    double x = 0;
    double y = 0;
    double xx = 0;
    double xy = 0;
    for (const auto& [hri2, half2] : windows) {
        const double expected = old.at(hri2);
        const double deviation = (half2 - expected) / (scatter * expected);
        const double weight =
            (degrees + 1) / (degrees + deviation * deviation) / (expected * expected);
        w += weight;
        x += weight * hri2;
        y += weight * half2;
        xx += weight * hri2 * hri2;
        xy += weight * hri2 * half2;
    }
    const double spread = w * xx - x * x;
    if (spread > min_spread * w * xx) {
        const Level level{(w * xy - x * y) / spread, (xx * y - x * xy) / spread};
        if (level.gain > 0 && level.noise_mm2 > 0) {
            return level;
        }
    }
    return {xy / xx, 0};
}

/// Excess of half² over its level.
double excess_of(const Level& level, const Squares& window) {
    return std::min(window.half2 / level.at(window.hri2), max_excess);
}

/// Fits the level with Student's t for relative deviations: bends and single defects do not count.
/// Then scales it so that the mean MRI of the windows is that of the trip's ratio: what the fit
/// takes for outliers lies above it, which would raise a whole trip.
Level level_of(const std::vector<Squares>& windows, double trip_ratio) {
    Level level{median_ratio(windows), 0};
    for (int round = 0; round < rounds && level.gain > 0; ++round) {
        level = refitted(windows, level);
    }
    for (int round = 0; round < rounds && level.gain > 0; ++round) {
        double usual = 0;
        double found = 0;
        for (const auto& window : windows) {
            const double hri = std::sqrt(window.hri2);
            usual += hri / trip_ratio;
            found += hri / ratio_at(excess_of(level, window), trip_ratio);
        }
        const double factor = std::pow(found / usual, 1 / elasticity);
        level = {level.gain * factor, level.noise_mm2 * factor};
    }
    return level;
}

} // namespace

std::optional<TrackDifference> track_difference_of(const IriTrace& trace, const Vehicle& vehicle) {
    TrackDifference found{.runs = {}};
    std::vector<Squares> windows;
    for (const auto& run : trace.runs) {
        auto difference = difference_of(run);
        if (!difference) {
            continue;
        }
        const double end_m =
            difference->start_travel_m +
            difference->cell_m * static_cast<double>(difference->half_mm_per_m.size());
        for (double at_m = difference->start_travel_m + difference->lead_in_m;
             at_m + window_m <= end_m;
             at_m += window_m) {
            Strength window;
            add(*difference, at_m, at_m + window_m, window);
            if (window.centre > 0) {
                windows.push_back({std::pow(window.centre / window.covered_m, 2),
                                   std::pow(window.half / window.covered_m, 2)});
            }
        }
        found.runs.push_back(std::move(*difference));
    }
    if (windows.size() < min_windows) {
        return std::nullopt;
    }
    if (vehicle.axles) {
        found.trip_ratio = std::lerp(hri_over_mri, drawn_ratio(trace), trip_part);
    }
    const auto level = level_of(windows, found.trip_ratio);
    found.gain = level.gain;
    found.noise_mm2 = level.noise_mm2;
    return found.gain > 0 ? std::optional{std::move(found)} : std::nullopt;
}

HriRatio ratio_over(const std::optional<TrackDifference>& difference, double from_m, double to_m) {
    const HriRatio usual{hri_over_mri, sd_hri_over_mri};
    if (!difference) {
        return usual;
    }
    const double wider_m = std::max(0.0, window_m - (to_m - from_m)) / 2;
    Strength sum;
    for (const auto& run : difference->runs) {
        add(run, from_m - wider_m, to_m + wider_m, sum);
    }
    if (!(sum.covered_m >= window_m / 2) || !(sum.centre > 0)) {
        return usual;
    }
    const double hri2 = std::pow(sum.centre / sum.covered_m, 2);
    const double half2 = std::pow(sum.half / sum.covered_m, 2);
    const Level level{difference->gain, difference->noise_mm2};
    return {ratio_at(excess_of(level, {hri2, half2}), difference->trip_ratio), sd_of_found_ratio};
}

std::optional<Headline> headline_of(const IriMean& mean, const HriRatio& ratio) {
    if (mean.mri_mm_per_m) {
        return Headline{*mean.mri_mm_per_m, mean.sd_mm_per_m, false};
    }
    if (!mean.hri_mm_per_m) {
        return std::nullopt;
    }
    // The relative variances of a quotient add up:
    // (hri sd / ratio)^2 + (iri * sd of ratio / ratio)^2.
    const double iri = *mean.hri_mm_per_m / ratio.hri_over_mri;
    return Headline{
        iri,
        std::hypot(mean.sd_mm_per_m / ratio.hri_over_mri, iri * ratio.sd / ratio.hri_over_mri),
        true};
}

} // namespace macadam
