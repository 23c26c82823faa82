#include "mapping/comparison/profile_agreement.hpp"

#include "estimator/common/error.hpp"
#include "estimator/iri/iri.hpp"
#include "estimator/motion/butterworth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

namespace macadam {
namespace {

constexpr std::array bands{ProfileBand{"IRI", 0, 0},
                           ProfileBand{"long", 8, 40},
                           ProfileBand{"medium", 1.6, 8},
                           ProfileBand{"short", 0.32, 1.6}};
constexpr int filter_order = 4;
constexpr double min_shared_m = 20;
constexpr double min_step_m = 1e-4;     // a finer one is a mistake of units
constexpr double min_grid_m = 0.01;     // finer than any wave of the bands needs
constexpr double max_elevation_m = 1e5; // beyond it, squares of slopes could lose the waves
constexpr double min_variance = 1e-12;  // (mm/m)^2; less is rounding
constexpr double band_lag_m = 0.5; // two bands of one profile are delayed differently by its filter

/// Filtered profile at the points `first`, `first` + 1, ... of a grid that both profiles share.
struct GridSignal {
    std::int64_t first = 0;
    std::vector<double> value;

    std::int64_t past() const { return first + static_cast<std::int64_t>(value.size()); }
};

/// Filtered profile at even stations.
struct FilteredTrack {
    double first_m;
    double step_m;
    std::vector<double> value;
};

std::vector<double> slope_mm_per_m(const TrackProfile& track) {
    std::vector<double> slope;
    slope.reserve(track.elevation_m.size());
    for (std::size_t i = 0; i + 1 < track.elevation_m.size(); ++i) {
        slope.push_back(1000 * (track.elevation_m[i + 1] - track.elevation_m[i]) / track.step_m);
    }
    return slope;
}

/// Filters the slope to wavelengths between the two of the band.
std::vector<double> band_pass(std::vector<double> slope, double step_m, const ProfileBand& band) {
    const double rate = 1 / step_m; // samples per metre
    const auto settle = static_cast<std::size_t>(std::ceil(2 * band.to_m / step_m));
    slope = zero_phase(butterworth_highpass(filter_order, 1 / band.to_m, rate), slope, settle);
    if (1 / band.from_m < 0.45 * rate) { // otherwise the profile holds no shorter waves anyhow
        slope = zero_phase(butterworth_lowpass(filter_order, 1 / band.from_m, rate), slope, settle);
    }
    return slope;
}

/// Filters a profile, without the ends in which the filter settles.
FilteredTrack filtered(const TrackProfile& track, const ProfileBand& band) {
    const bool is_iri = band.to_m == 0;
    auto value = is_iri ? suspension_stroke_mm_per_m(track.elevation_m, track.step_m)
                        : band_pass(slope_mm_per_m(track), track.step_m, band);
    const double length_m = static_cast<double>(value.size()) * track.step_m;
    const double end_m = is_iri ? 0 : std::min(band.to_m, length_m / 8);
    const auto points = [&](double metres) {
        return std::min(value.size(), static_cast<std::size_t>(std::ceil(metres / track.step_m)));
    };
    const auto first = points(std::max(start_up_m, end_m));
    value.resize(value.size() - points(end_m));
    value.erase(value.begin(),
                value.begin() + static_cast<std::ptrdiff_t>(std::min(first, value.size())));
    // A value belongs to the middle of the steps that its slope spans.
    const double steps = is_iri ? static_cast<double>(envelope_steps(track.step_m)) : 1;
    return {track.first_m + (static_cast<double>(first) + steps / 2) * track.step_m,
            track.step_m,
            std::move(value)};
}

/// Interpolates to the grid of multiples of `step_m`.
GridSignal on_grid(const FilteredTrack& track, double step_m) {
    GridSignal signal;
    if (track.value.size() < 2) {
        return signal;
    }
    signal.first = static_cast<std::int64_t>(std::ceil(track.first_m / step_m - 1e-9));
    for (std::int64_t i = signal.first;; ++i) {
        const double place = (static_cast<double>(i) * step_m - track.first_m) / track.step_m;
        const double whole = std::floor(std::max(place, 0.0));
        const auto at = static_cast<std::size_t>(whole);
        if (at + 1 >= track.value.size()) {
            return signal;
        }
        const double part = std::max(place, 0.0) - whole;
        signal.value.push_back(track.value[at] + part * (track.value[at + 1] - track.value[at]));
    }
}

/// Values of both signals on the same road, of equal length.
struct SharedRoad {
    std::span<const double> a;
    std::span<const double> b;
};

/// Overlap of the signals if b is `lag` grid points behind: point i of a is point i + lag of b.
SharedRoad shared_at(const GridSignal& a, const GridSignal& b, std::int64_t lag) {
    const auto first = std::max(a.first, b.first - lag);
    const auto past = std::min(a.past(), b.past() - lag);
    if (past <= first) {
        return {};
    }
    const auto count = static_cast<std::size_t>(past - first);
    return {std::span{a.value}.subspan(static_cast<std::size_t>(first - a.first), count),
            std::span{b.value}.subspan(static_cast<std::size_t>(first + lag - b.first), count)};
}

/// Score of one lag and its factors.
struct LagScore {
    double score;
    double correlation;
    double gain;
};

LagScore score_of(const SharedRoad& road) {
    double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    for (std::size_t i = 0; i < road.a.size(); ++i) {
        a += road.a[i];
        b += road.b[i];
        aa += road.a[i] * road.a[i];
        bb += road.b[i] * road.b[i];
        ab += road.a[i] * road.b[i];
    }
    const auto count = static_cast<double>(road.a.size());
    const auto variance_of = [&](double sum, double squares) {
        const double variance = squares - sum * sum / count;
        return variance < min_variance * count ? 0 : variance;
    };
    const double variance_a = variance_of(a, aa);
    const double variance_b = variance_of(b, bb);
    const double covariance = ab - a * b / count;
    if (!(variance_a > 0 && variance_b > 0)) {
        const double equal = variance_a == variance_b ? 1 : 0; // two planes agree
        return {equal, equal, 1};
    }
    return {covariance / std::max(variance_a, variance_b),
            covariance / std::sqrt(variance_a * variance_b),
            std::sqrt(variance_a / variance_b)};
}

/// Lags from `first` to `last` grid points.
struct LagRange {
    std::int64_t first;
    std::int64_t last;
};

/// Best lag in grid points, with the maximum of the parabola through it and its neighbours.
struct BestLag {
    std::int64_t whole;
    double lag;
    LagScore at;
};

std::optional<BestLag>
best_lag(const GridSignal& a, const GridSignal& b, const LagRange& range, std::size_t min_points) {
    std::optional<BestLag> best;
    const auto at = [&](std::int64_t lag) -> std::optional<LagScore> {
        const auto road = shared_at(a, b, lag);
        return road.a.size() < min_points ? std::nullopt : std::optional{score_of(road)};
    };
    for (auto lag = range.first; lag <= range.last; ++lag) {
        const auto score = at(lag);
        if (score && (!best || score->score > best->at.score)) {
            best = BestLag{lag, static_cast<double>(lag), *score};
        }
    }
    if (!best) {
        return best;
    }
    const auto before = at(best->whole - 1), after = at(best->whole + 1);
    if (before && after) {
        const double slope = (after->score - before->score) / 2;
        const double bend = after->score - 2 * best->at.score + before->score;
        const double shift = bend < 0 ? std::clamp(-slope / bend, -0.5, 0.5) : 0;
        const double more = shift * slope + shift * shift * bend / 2;
        const double factor = best->at.score > 0 ? (best->at.score + more) / best->at.score : 1;
        best->lag += shift;
        best->at.correlation = std::min(1.0, best->at.correlation * factor);
        best->at.score = std::min(1.0, best->at.score + more);
    }
    return best;
}

double mean_magnitude(std::span<const double> values) {
    double sum = 0;
    for (const double value : values) {
        sum += std::abs(value);
    }
    return sum / static_cast<double>(values.size());
}

std::vector<AgreementPair>
intervals_of(const SharedRoad& road, std::size_t points, std::int64_t way_id) {
    std::vector<AgreementPair> intervals;
    for (std::size_t i = 0; i + points <= road.a.size(); i += points) {
        intervals.push_back({{way_id, true, static_cast<std::uint32_t>(intervals.size())},
                             mean_magnitude(road.a.subspan(i, points)),
                             mean_magnitude(road.b.subspan(i, points))});
    }
    return intervals;
}

void expect_comparable(const TrackProfile& track) {
    if (!(track.step_m >= min_step_m)) {
        throw InputError{fmt::format(
            "profile step is {:g} m, expected at least {:g}", track.step_m, min_step_m)};
    }
    const auto beyond = std::ranges::find_if_not(
        track.elevation_m, [](double z) { return std::abs(z) <= max_elevation_m; });
    if (beyond != track.elevation_m.end()) {
        throw InputError{fmt::format("elevation {} of a profile is {:g} m, expected at most {:g} m "
                                     "above or below 0",
                                     beyond - track.elevation_m.begin() + 1,
                                     *beyond,
                                     max_elevation_m)};
    }
}

std::int64_t points_in(double length_m, double step_m) {
    return std::max<std::int64_t>(1, std::llround(length_m / step_m));
}

} // namespace

std::span<const ProfileBand> profile_bands() {
    return bands;
}

TrackAgreement compare_tracks(const TrackProfile& a,
                              const TrackProfile& b,
                              std::int64_t way_id,
                              const ProfileComparisonConfig& config) {
    expect_comparable(a);
    expect_comparable(b);
    const double step_m = std::max(std::min(a.step_m, b.step_m), min_grid_m);
    const double coarser_m = std::max(a.step_m, b.step_m);
    const auto min_points = static_cast<std::size_t>(points_in(min_shared_m, step_m));
    TrackAgreement agreement{};
    std::int64_t iri_lag = 0;
    for (const auto& band : bands) {
        if (band.from_m > 0 && 2 * coarser_m > band.from_m * (1 + 1e-9)) {
            continue;
        }
        const auto left = on_grid(filtered(a, band), step_m);
        const auto right = on_grid(filtered(b, band), step_m);
        const bool is_iri = band.to_m == 0;
        const auto reach = points_in(is_iri ? config.max_lag_m : band_lag_m, step_m);
        const auto best = best_lag(left, right, {iri_lag - reach, iri_lag + reach}, min_points);
        if (!best) {
            throw InputError{fmt::format("the profiles share less than {:g} m of road after the "
                                         "first {:g} m, expected stations that overlap, or differ "
                                         "by at most {:g} m",
                                         min_shared_m,
                                         start_up_m,
                                         config.max_lag_m)};
        }
        if (is_iri) {
            const auto road = shared_at(left, right, best->whole);
            iri_lag = best->whole;
            agreement.shared_m = static_cast<double>(road.a.size()) * step_m;
            agreement.iri_a = mean_magnitude(road.a);
            agreement.iri_b = mean_magnitude(road.b);
            agreement.intervals = intervals_of(
                road, static_cast<std::size_t>(points_in(config.interval_m, step_m)), way_id);
        }
        agreement.bands.push_back(
            {band, best->at.score, best->at.correlation, best->at.gain, best->lag * step_m});
    }
    return agreement;
}

} // namespace macadam
