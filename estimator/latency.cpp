#include "estimator/latency.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace macadam {
namespace {

constexpr double lag_step_s = 0.05;
constexpr int lags = 61;                // 0 to 3 s
constexpr std::size_t least_fixes = 30; // fewer agree by chance
constexpr double longest_step_s = 0.5;  // between wheel speeds that are joined by a line
constexpr double clear_share = 0.5;     // of the worst lag's deviation: the best must be below it

float median_of(std::vector<float> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// Wheel speed at a time; NaN in its silences.
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

/// How far the two speeds stand apart if the receiver is so late; NaN if too few can be compared.
double deviation_mps(const TripLog& trip, double lag_s) {
    std::vector<float> apart_mps;
    for (const auto& fix : trip.fixes) {
        const float apart =
            fix.speed_mps - wheel_mps(trip.speed, fix.t_s - lag_s + trip.meta.speed_latency_s);
        if (std::isfinite(apart)) {
            apart_mps.push_back(apart);
        }
    }
    if (apart_mps.size() < least_fixes) {
        return NAN;
    }
    const float middle = median_of(apart_mps);
    std::ranges::transform(
        apart_mps, apart_mps.begin(), [=](float a) { return std::abs(a - middle); });
    // The mean, not the median: most of a drive is even, and only its changes tell the lag.
    double sum = 0;
    for (const float a : apart_mps) {
        sum += std::min(a, 3.0F); // a faulty reading counts no more than this
    }
    return sum / static_cast<double>(apart_mps.size());
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
    const auto i = best - deviations.begin();
    if (i == 0 || i + 1 == lags) {
        return static_cast<double>(i) * lag_step_s;
    }
    // The vertex of the parabola through the best lag and its neighbours.
    const double before = *(best - 1);
    const double after = *(best + 1);
    const double bend = before - 2 * *best + after;
    return (static_cast<double>(i) + (bend > 0 ? 0.5 * (before - after) / bend : 0)) * lag_step_s;
}

} // namespace macadam
