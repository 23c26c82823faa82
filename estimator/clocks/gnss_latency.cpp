#include "estimator/clocks/gnss_latency.hpp"

#include "estimator/clocks/turn_latency.hpp"
#include "estimator/common/angle.hpp"
#include "estimator/common/statistics.hpp"
#include "estimator/motion/gnss_track.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace macadam {
namespace {

constexpr double lag_step_s = 0.05;
constexpr int lags = 61;               // 0 to 3 s
constexpr std::size_t min_fixes = 30;  // fewer may agree by chance
constexpr double longest_step_s = 0.5; // between wheel speeds that are interpolated
constexpr double clear_share = 0.5;    // best deviation over that of the worst lag, at most

constexpr double min_chord_m = 8;
constexpr double longest_chord_s = 6;
constexpr double min_sd_s = 0.03;  // lower limit of the accuracy of any clock
constexpr double worst_sd_s = 0.4; // of a usable result
constexpr float max_apart_mps = 3; // limits the effect of a faulty reading

/// Interpolates the wheel speed at a time; NaN in gaps.
float wheel_mps(const SpeedSamples& wheels, double t_s) {
    const auto after = std::ranges::upper_bound(wheels.t_s, t_s);
    if (after == wheels.t_s.begin() || after == wheels.t_s.end()) {
        return NAN;
    }
    const auto i = static_cast<std::size_t>(after - wheels.t_s.begin());
    const double step_s = wheels.t_s[i] - wheels.t_s[i - 1];
    if (step_s > longest_step_s) {
        return NAN;
    }
    const auto share = static_cast<float>((t_s - wheels.t_s[i - 1]) / step_s);
    return std::lerp(wheels.speed_mps[i - 1], wheels.speed_mps[i], share);
}

/// Returns the mean deviation of the two speeds for a receiver latency; NaN if too few can be
/// compared.
double deviation_mps(const TripLog& trip, double lag_s) {
    std::vector<float> apart_mps;
    for (const auto& fix : trip.fixes) {
        const float apart =
            fix.speed_mps - wheel_mps(trip.speed, fix.t_s - lag_s + trip.meta.speed_latency_s);
        if (std::isfinite(apart)) {
            apart_mps.push_back(apart);
        }
    }
    if (apart_mps.size() < min_fixes) {
        return NAN;
    }
    const float middle = median(apart_mps);
    std::ranges::transform(
        apart_mps, apart_mps.begin(), [=](float a) { return std::abs(a - middle); });
    // The mean is used, not the median: speed is constant for most of a drive, and only its changes
    // determine the lag.
    double sum = 0;
    for (const float a : apart_mps) {
        sum += std::min(a, 3.0F); // limits the effect of a faulty reading
    }
    return sum / static_cast<double>(apart_mps.size());
}

// ------------------------------------------------------------ from fix to fix, and turns

/// Integrates the wheel speeds to metres at each reading's time.
std::vector<double> wheel_travel_m(const SpeedSamples& wheels) {
    std::vector<double> travel_m(wheels.t_s.size(), 0.0);
    for (std::size_t i = 1; i < travel_m.size(); ++i) {
        const double mean_mps =
            static_cast<double>(wheels.speed_mps[i - 1] + wheels.speed_mps[i]) / 2;
        travel_m[i] = travel_m[i - 1] + mean_mps * (wheels.t_s[i] - wheels.t_s[i - 1]);
    }
    return travel_m;
}

double travel_at(const SpeedSamples& wheels, const std::vector<double>& travel_m, double t_s) {
    const auto after = std::ranges::upper_bound(wheels.t_s, t_s) - wheels.t_s.begin();
    if (after == 0 || after == std::ssize(wheels.t_s)) {
        return NAN;
    }
    const auto i = static_cast<std::size_t>(after);
    const double share = (t_s - wheels.t_s[i - 1]) / (wheels.t_s[i] - wheels.t_s[i - 1]);
    return std::lerp(travel_m[i - 1], travel_m[i], share);
}

/// Returns the -log likelihood of differences with one median and heavy tails (Laplace's
/// distribution); 0 if too few can be compared. Neighbours share a fix, so that two count as one.
double cost_of(std::vector<float> apart, float most) {
    if (apart.size() < min_fixes) {
        return 0;
    }
    const float middle = median(apart);
    double sum = 0;
    for (const float a : apart) {
        sum += static_cast<double>(std::min(std::abs(a - middle), most));
    }
    const auto n = static_cast<double>(apart.size());
    return n / 2 * std::log(std::max(sum / n, 1e-3));
}

/// Returns the cost of a lag from the speeds between fixes and the wheel speeds.
double speed_cost(const std::vector<GnssChord>& chords,
                  const SpeedSamples& wheels,
                  const std::vector<double>& travel_m,
                  double lag_s) {
    std::vector<float> apart_mps;
    for (const auto& chord : chords) {
        const double way_m = travel_at(wheels, travel_m, chord.to_s - lag_s) -
                             travel_at(wheels, travel_m, chord.from_s - lag_s);
        if (std::isfinite(way_m)) {
            const double duration_s = chord.to_s - chord.from_s;
            apart_mps.push_back(
                static_cast<float>(chord.length_m / duration_s - way_m / duration_s));
        }
    }
    return cost_of(std::move(apart_mps), max_apart_mps);
}

/// Returns the vertex of the parabola through the minimum of the values and its neighbours, as a
/// lag.
double vertex_s(const std::vector<double>& values) {
    const auto best = std::ranges::min_element(values);
    const auto i = best - values.begin();
    if (i == 0 || best + 1 == values.end()) {
        return static_cast<double>(i) * lag_step_s;
    }
    const double before = *(best - 1);
    const double after = *(best + 1);
    const double bend = before - 2 * *best + after;
    return (static_cast<double>(i) + (bend > 0 ? 0.5 * (before - after) / bend : 0)) * lag_step_s;
}

/// Returns mean and sd over lags with a uniform prior, which draws uncertain estimates to the
/// middle.
FoundLatency posterior(const std::vector<double>& lags_s, const std::vector<double>& costs) {
    const double least = std::ranges::min(costs);
    double sum = 0;
    double first = 0;
    double second = 0;
    for (std::size_t i = 0; i < lags_s.size(); ++i) {
        const double weight = std::exp(least - costs[i]);
        sum += weight;
        first += weight * lags_s[i];
        second += weight * lags_s[i] * lags_s[i];
    }
    const double mean_s = first / sum;
    const double spread_s = std::sqrt(std::max(0.0, second / sum - mean_s * mean_s));
    return {mean_s, std::max(spread_s, min_sd_s)};
}

} // namespace

std::optional<double> estimate_gnss_latency_s(const TripLog& trip) {
    std::vector<double> deviations;
    for (int i = 0; i < lags; ++i) {
        deviations.push_back(deviation_mps(trip, i * lag_step_s));
        if (std::isnan(deviations.back())) {
            return std::nullopt;
        }
    }
    const auto best = std::ranges::min_element(deviations);
    if (!(*best < clear_share * std::ranges::max(deviations))) {
        return std::nullopt;
    }
    return vertex_s(deviations);
}

std::optional<FoundLatency> find_gnss_latency(const TripLog& trip, const Heading& heading) {
    if (const auto by_speeds_s = estimate_gnss_latency_s(trip)) {
        return FoundLatency{*by_speeds_s, latency_by_speeds_sd_s};
    }
    const auto chords = gnss_chords(trip, min_chord_m, longest_chord_s);
    const auto travel_m = wheel_travel_m(trip.speed);
    std::vector<double> lags_s;
    for (int i = 0; i < lags; ++i) {
        lags_s.push_back(i * lag_step_s);
    }
    auto costs = turn_latency_costs(trip, heading, lags_s);
    for (std::size_t i = 0; i < costs.size(); ++i) {
        costs[i] += speed_cost(chords, trip.speed, travel_m, lags_s[i] - trip.meta.speed_latency_s);
    }
    const auto found = posterior(lags_s, costs);
    return found.sd_s < worst_sd_s ? std::optional{found} : std::nullopt;
}

} // namespace macadam
