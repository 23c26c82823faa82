#include "estimator/motion/stretch.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/statistics.hpp"
#include "estimator/motion/butterworth.hpp"
#include "estimator/motion/mounting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr int alias_order = 8;
constexpr double alias_corner =
    0.46;                            // of the new rate: a quarter of the power there; what is above
                                     // 0.54 of it, and would fold onto lower ones, falls to 1e-2
constexpr double same_rate = 1.05;   // a log this much faster than the grid needs no filter
constexpr double settle_periods = 4; // of the filter's corner, at both ends
constexpr double minor_share = 0.2;  // of an axis that need not be sampled: sin(11.5 degrees)
constexpr std::size_t min_samples = 16;

void check_rate(const TriaxialSamples& acc, const StretchConfig& config) {
    const double rate_hz = 1 / median_step_s(acc.t_s);
    // Tolerates clocks that are slightly slow.
    if (rate_hz < config.min_rate_hz * 0.99) {
        throw InputError{fmt::format("acceleration was sampled at {:.1f} Hz, expected at least "
                                     "{:g}",
                                     rate_hz,
                                     config.min_rate_hz)};
    }
}

/// Returns the reason for which the trip's motion at a time does not belong to a stretch; 0 if it
/// does.
std::uint8_t unfit(const Odometer& odometer, double t_s, double min_speed_mps) {
    const double speed_mps = odometer.speed_mps(t_s);
    if (std::isnan(speed_mps)) {
        return code(RowReason::no_speed);
    }
    return speed_mps < min_speed_mps || odometer.reversing(t_s) ? code(RowReason::too_slow) : 0;
}

/// \param spans  in order, not overlapping.
bool is_within(std::span<const TimeSpan> spans, double t_s) {
    const auto span = std::ranges::lower_bound(spans, t_s, {}, &TimeSpan::to_s);
    return span != spans.end() && t_s >= span->from_s;
}

enum class Axis : int { x = 0, y = 1, z = 2 };

/// Values of one of the vehicle's axes at their own times, without samples that lack a reading.
struct Trace {
    std::vector<double> t_s;
    std::vector<double> value;
};

bool contributes(const Mounting& mounting, Axis axis, int sensor_axis) {
    return std::abs(mounting.to_vehicle(static_cast<int>(axis), sensor_axis)) > minor_share;
}

Trace rotated(const TriaxialSamples& samples,
              const StretchSpan& span,
              const Mounting& mounting,
              Axis axis) {
    const std::vector<float>* readings[] = {&samples.x, &samples.y, &samples.z};
    Trace trace;
    for (std::size_t i = span.first; i <= span.last; ++i) {
        double sum = 0;
        bool whole = true;
        for (int from = 0; from < 3; ++from) {
            const auto reading = static_cast<double>((*readings[from])[i]);
            if (std::isnan(reading)) {
                whole = whole && !contributes(mounting, axis, from);
            } else {
                sum += mounting.to_vehicle(static_cast<int>(axis), from) * reading;
            }
        }
        if (whole) {
            trace.t_s.push_back(samples.t_s[i]);
            trace.value.push_back(sum);
        }
    }
    return trace;
}

/// Returns the slope of a cubic at a knot: that of the parabola through it and its neighbours.
double tangent(const Trace& trace, std::size_t i) {
    const auto slope = [&](std::size_t a) {
        return (trace.value[a + 1] - trace.value[a]) / (trace.t_s[a + 1] - trace.t_s[a]);
    };
    const std::size_t last = trace.t_s.size() - 1;
    if (i == 0 || i == last) {
        return slope(i == 0 ? 0 : last - 1);
    }
    const double before_s = trace.t_s[i] - trace.t_s[i - 1];
    const double after_s = trace.t_s[i + 1] - trace.t_s[i];
    return (slope(i - 1) * after_s + slope(i) * before_s) / (before_s + after_s);
}

/// Interpolates the trace on an even grid by cubic Hermite pieces between its own stamps.
std::vector<double> on_grid(const Trace& trace, double start_s, double step_s, std::size_t count) {
    std::vector<double> out(count);
    std::size_t piece = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double t_s = start_s + static_cast<double>(i) * step_s;
        while (piece + 2 < trace.t_s.size() && trace.t_s[piece + 1] <= t_s) {
            ++piece;
        }
        const double length_s = trace.t_s[piece + 1] - trace.t_s[piece];
        const double u = std::clamp((t_s - trace.t_s[piece]) / length_s, 0.0, 1.0);
        const double w = 1 - u;
        out[i] = w * w * (1 + 2 * u) * trace.value[piece] +
                 u * u * (1 + 2 * w) * trace.value[piece + 1] +
                 u * w * length_s * (w * tangent(trace, piece) - u * tangent(trace, piece + 1));
    }
    return out;
}

struct Grid {
    double start_s;
    double step_s;
    std::size_t count;
};

Grid grid_of(double from_s, double to_s, double rate_hz) {
    // Rounding of a time stamp must not cost the last sample.
    const auto steps = static_cast<std::size_t>((to_s - from_s) * rate_hz + 1e-6);
    return {from_s, 1 / rate_hz, steps + 1};
}

double own_rate_hz(const TriaxialSamples& samples, const StretchSpan& span) {
    return static_cast<double>(span.last - span.first) /
           (samples.t_s[span.last] - samples.t_s[span.first]);
}

/// Resamples the trace on the grid, low-passed first if it is finer.
std::vector<double> evened(Trace trace, const Grid& grid, double own_hz) {
    if (own_hz * grid.step_s > same_rate) {
        const auto fine = grid_of(trace.t_s.front(), trace.t_s.back(), own_hz);
        const auto sections = butterworth_lowpass(alias_order, alias_corner / grid.step_s, own_hz);
        const auto settle =
            static_cast<std::size_t>(settle_periods * own_hz * grid.step_s / alias_corner) + 1;
        trace.value =
            zero_phase(sections, on_grid(trace, fine.start_s, fine.step_s, fine.count), settle);
        trace.t_s.resize(fine.count);
        for (std::size_t i = 0; i < fine.count; ++i) {
            trace.t_s[i] = fine.start_s + static_cast<double>(i) * fine.step_s;
        }
    }
    return on_grid(trace, grid.start_s, grid.step_s, grid.count);
}

/// Returns one axis of the accelerometer on the grid, less its mean; empty if it was not sampled
/// throughout.
std::vector<float> channel(const TripLog& trip,
                           const StretchSpan& span,
                           const Mounting& mounting,
                           Axis axis,
                           const Grid& grid) {
    auto trace = rotated(trip.acc, span, mounting, axis);
    if (trace.t_s.size() < min_samples || 2 * trace.t_s.size() < span.last - span.first + 1) {
        return {};
    }
    const auto even = evened(std::move(trace), grid, own_rate_hz(trip.acc, span));
    double sum = 0;
    for (const double value : even) {
        sum += value;
    }
    const double mean = sum / static_cast<double>(even.size());
    std::vector<float> out(even.size());
    std::ranges::transform(
        even, out.begin(), [&](double v) { return static_cast<float>(v - mean); });
    return out;
}

struct Rate {
    std::vector<float> values;
    double noise = 0; ///< standard deviation of a sample beyond the motion of a car
};

/// Estimates white noise with the power of a trace near half its sampling rate, from its fourth
/// differences: standard deviation of a sample. The median is used, so that bumps have no effect.
double noise_floor(const std::vector<double>& values) {
    constexpr double sum_of_squares = 70; // of the weights 1, -4, 6, -4, 1
    std::vector<double> differences;
    for (std::size_t i = 2; i + 2 < values.size(); ++i) {
        differences.push_back(std::abs(values[i - 2] - 4 * values[i - 1] + 6 * values[i] -
                                       4 * values[i + 1] + values[i + 2]));
    }
    return normal_sd_per_mad * median(std::move(differences)) / std::sqrt(sum_of_squares);
}

/// Returns one axis of the gyroscope on the grid; empty if it was not sampled throughout at the
/// accelerometer's minimum rate.
Rate rate_channel(const TripLog& trip,
                  const Mounting& mounting,
                  Axis axis,
                  const Grid& grid,
                  const StretchConfig& config) {
    const auto& t_s = trip.gyro.t_s;
    const double end_s = grid.start_s + grid.step_s * static_cast<double>(grid.count - 1);
    const auto after = std::ranges::upper_bound(t_s, grid.start_s);
    const auto end = std::ranges::lower_bound(t_s, end_s);
    if (after == t_s.begin() || end == t_s.end()) {
        return {};
    }
    const StretchSpan span{static_cast<std::size_t>(after - t_s.begin() - 1),
                           static_cast<std::size_t>(end - t_s.begin())};
    auto trace = rotated(trip.gyro, span, mounting, axis);
    if (trace.t_s.size() < min_samples || trace.t_s.front() > grid.start_s ||
        trace.t_s.back() < end_s) {
        return {};
    }
    const double own_hz = own_rate_hz(trip.gyro, span);
    const double max_gap_s =
        std::max(config.max_gap_s, config.max_gap_steps * median_step_s(trace.t_s));
    const auto gap = std::ranges::adjacent_find(
        trace.t_s, [=](double from_s, double to_s) { return to_s - from_s > max_gap_s; });
    if (gap != trace.t_s.end() || own_hz < config.min_rate_hz * 0.99) {
        return {};
    }
    const double kept = std::sqrt(std::min(1.0, 1 / (grid.step_s * own_hz)));
    const double noise = kept * noise_floor(trace.value);
    const auto even = evened(std::move(trace), grid, own_hz);
    return {{even.begin(), even.end()}, noise};
}

/// Returns the rate of the grid of a stretch.
double grid_rate_hz(const TripLog& trip,
                    const StretchSpan& span,
                    const Odometer& odometer,
                    const StretchConfig& config) {
    const double own_hz = own_rate_hz(trip.acc, span);
    if (config.rate_hz > 0) {
        return config.rate_hz;
    }
    if (config.samples_a_metre > 0) {
        const double from_s = trip.acc.t_s[span.first];
        const double to_s = trip.acc.t_s[span.last];
        double fastest_mps = 0;
        for (double t_s = from_s; t_s <= to_s; t_s += 1) {
            fastest_mps = std::max(fastest_mps, odometer.speed_mps(t_s));
        }
        const double enough_hz =
            std::max(config.enough_rate_hz, config.samples_a_metre * fastest_mps);
        return own_hz / std::max(1.0, std::floor(own_hz / enough_hz));
    }
    return std::min(own_hz, config.max_rate_hz);
}

} // namespace

double median_step_s(const std::vector<double>& t_s) {
    std::vector<double> steps_s(t_s.size() - 1);
    for (std::size_t i = 0; i < steps_s.size(); ++i) {
        steps_s[i] = t_s[i + 1] - t_s[i];
    }
    return median(std::move(steps_s));
}

std::vector<TravelSpan> slow_parts(const Odometer& odometer, double min_speed_mps) {
    const auto& knots = odometer.knots();
    std::vector<TravelSpan> parts;
    for (std::size_t i = 0; i + 1 < knots.t_s.size(); ++i) {
        const double middle_s = (knots.t_s[i] + knots.t_s[i + 1]) / 2;
        const double from_m = knots.travel_m[i];
        const double to_m = knots.travel_m[i + 1];
        if (to_m > from_m &&
            unfit(odometer, middle_s, min_speed_mps) == code(RowReason::too_slow)) {
            if (!parts.empty() && parts.back().to_m == from_m) {
                parts.back().to_m = to_m;
            } else {
                parts.push_back({from_m, to_m});
            }
        }
    }
    return parts;
}

FoundStretches find_stretches(const TripLog& trip,
                              const Odometer& odometer,
                              const StretchConfig& config,
                              std::span<const TimeSpan> moved) {
    const auto& t_s = trip.acc.t_s;
    FoundStretches found{.spans = {}, .acc = SampleUse(t_s.size(), code(RowReason::short_stretch))};
    if (t_s.size() < 2) {
        return found;
    }
    check_rate(trip.acc, config);

    const auto keep = [&](std::size_t first, std::size_t end) {
        const bool whole =
            end - first >= min_samples &&
            odometer.travel_m(t_s[end - 1]) - odometer.travel_m(t_s[first]) >= config.min_length_m;
        if (whole) {
            std::fill(found.acc.begin() + static_cast<std::ptrdiff_t>(first),
                      found.acc.begin() + static_cast<std::ptrdiff_t>(end),
                      std::uint8_t{0});
            found.spans.push_back({first, end - 1});
        }
    };
    const double max_gap_s = std::max(config.max_gap_s, config.max_gap_steps * median_step_s(t_s));
    std::size_t first = 0; // of the current stretch, which is empty if first == i
    for (std::size_t i = 0; i < t_s.size(); ++i) {
        const bool cut = i > first && (t_s[i] - t_s[i - 1] > max_gap_s ||
                                       t_s[i] - t_s[first] > config.longest_s);
        const auto reason = is_within(moved, t_s[i])
                                ? code(RowReason::sensor_moved)
                                : unfit(odometer, t_s[i], config.min_speed_mps);
        if ((cut || reason != 0) && i > first) {
            keep(first, i);
            first = i;
        }
        if (reason != 0) {
            found.acc[i] = reason;
            first = i + 1;
        }
    }
    if (first < t_s.size()) {
        keep(first, t_s.size());
    }
    return found;
}

Stretch make_stretch(const TripLog& trip,
                     const StretchSpan& span,
                     const Odometer& odometer,
                     const Mounting& mounting,
                     const StretchConfig& config) {
    const auto grid = grid_of(trip.acc.t_s[span.first],
                              trip.acc.t_s[span.last],
                              grid_rate_hz(trip, span, odometer, config));

    auto roll = rate_channel(trip, mounting, Axis::x, grid, config);
    auto pitch = rate_channel(trip, mounting, Axis::y, grid, config);
    Stretch stretch{.start_s = grid.start_s,
                    .step_s = grid.step_s,
                    .vertical_mps2 = channel(trip, span, mounting, Axis::z, grid),
                    .lateral_mps2 = channel(trip, span, mounting, Axis::y, grid),
                    .roll_radps = std::move(roll.values),
                    .pitch_radps = std::move(pitch.values),
                    .yaw_radps = rate_channel(trip, mounting, Axis::z, grid, config).values,
                    .roll_noise_radps = roll.noise,
                    .pitch_noise_radps = pitch.noise,
                    .speed_mps = std::vector<float>(grid.count),
                    .travel_m = std::vector<double>(grid.count)};
    for (std::size_t i = 0; i < grid.count; ++i) {
        const double t_s = grid.start_s + static_cast<double>(i) * grid.step_s;
        stretch.speed_mps[i] = static_cast<float>(odometer.speed_mps(t_s));
        stretch.travel_m[i] = odometer.travel_m(t_s);
    }
    return stretch;
}

} // namespace macadam
