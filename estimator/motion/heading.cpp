#include "estimator/motion/heading.hpp"

#include "estimator/common/angle.hpp"
#include "estimator/motion/gnss_track.hpp"
#include "estimator/motion/gyro_bias.hpp"
#include "estimator/motion/mounting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

namespace macadam {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

constexpr double longest_silence_s = 0.5; // bridged by a line
constexpr double slight_axis = 0.2;       // share of the vertical: such an axis may be missing

constexpr double noise_rad_per_sqrt_s = 0.002; // angle random walk, with mount vibration
constexpr double scale_sd = 0.01;              // of the gyro, and of hills: cos 6 degrees
constexpr double min_sd_rad = 0.003;           // from time stamps that differ from the sensor's

constexpr double standing_mps = 0.1;
constexpr double min_stand_s = 2;
constexpr double quiet_radps = 0.02;      // limit against people getting in
constexpr double stand_sd_radps = 0.0005; // of the mean rate while standing

constexpr double course_from_mps = 4;
constexpr double min_span_s = 20; // between courses that are compared
constexpr double max_span_s = 90;
constexpr double course_sd_rad = 3 * rad_per_deg;
constexpr double chord_sd_rad = 8 * rad_per_deg;
constexpr double min_chord_m = 15;
constexpr double longest_chord_s = 5;
constexpr double unstated_latency_sd_s = 0.7;
constexpr double stated_latency_sd_s = 0.1;
constexpr double contradiction_rad = 0.5;
constexpr double max_contradicting = 1.0 / 3;

double wrapped(double rad) {
    return std::remainder(rad, 2 * std::numbers::pi);
}

// -------------------------------------------------------------------------------- integration

/// Returns the rate about the vertical; NaN if a relevant axis was not sampled.
double vertical_rate(const TriaxialSamples& gyro, std::size_t i, const Eigen::Vector3d& up) {
    const float axes[] = {gyro.x[i], gyro.y[i], gyro.z[i]};
    double rate = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (!std::isnan(axes[axis])) {
            rate += up[axis] * static_cast<double>(axes[axis]);
        } else if (std::abs(up[axis]) > slight_axis) {
            return unknown;
        }
    }
    return rate;
}

/// \param spans  in order, not overlapping.
bool is_within(double t_s, std::span<const TimeSpan> spans) {
    const auto span = std::ranges::upper_bound(spans, t_s, {}, &TimeSpan::to_s);
    return span != spans.end() && span->from_s <= t_s;
}

double time_s(const Heading& heading, std::int64_t step) {
    return heading.start_s + heading.step_s * static_cast<double>(step);
}

/// Returns the last step that is not after a time.
std::int64_t last_step_until(const Heading& heading, double t_s) {
    auto step = static_cast<std::int64_t>(std::floor((t_s - heading.start_s) / heading.step_s));
    step += time_s(heading, step + 1) <= t_s ? 1 : 0; // corrects the rounding of the quotient
    step -= time_s(heading, step) > t_s ? 1 : 0;
    return step;
}

/// Integrates by trapezoids between the samples and samples the result at even times; silences have
/// values only at their ends.
Heading integrated(const TripLog& trip, const Mounting& mounting) {
    const Eigen::Vector3d up = mounting.to_vehicle.row(2);
    Heading heading;
    std::int64_t next = 0; // next step to be sampled
    double last_s = unknown;
    double last_radps = 0;
    double turned_rad = 0;
    for (std::size_t i = 0; i < trip.gyro.t_s.size(); ++i) {
        const double t_s = trip.gyro.t_s[i];
        const double radps = vertical_rate(trip.gyro, i, up);
        if (std::isnan(radps) || is_within(t_s, mounting.otherwise)) {
            continue;
        }
        if (std::isnan(last_s)) {
            heading.start_s = t_s;
            heading.turned_rad.push_back(0);
            heading.runs.push_back({0, 0});
            next = 1;
            last_s = t_s;
            last_radps = radps;
            continue;
        }
        const bool silent = t_s - last_s > longest_silence_s;
        if (silent) {
            heading.silent.push_back({last_s, t_s});
        }
        const double gain_rad = silent ? 0 : (last_radps + radps) / 2 * (t_s - last_s);
        const auto last = last_step_until(heading, t_s);
        if (silent && last > next + 1) {
            heading.turned_rad.push_back(static_cast<float>(turned_rad));
            heading.runs.push_back({last, heading.turned_rad.size()});
            next = last;
        }
        for (; next <= last; ++next) {
            const double share = (time_s(heading, next) - last_s) / (t_s - last_s);
            heading.turned_rad.push_back(static_cast<float>(turned_rad + share * gain_rad));
        }
        turned_rad += gain_rad;
        last_s = t_s;
        last_radps = radps;
    }
    return heading;
}

/// Returns the number of the last step.
std::int64_t end_step(const Heading& heading) {
    const auto& [first_step, first] = heading.runs.back();
    return first_step + static_cast<std::int64_t>(heading.turned_rad.size() - first) - 1;
}

double end_s(const Heading& heading) {
    return time_s(heading, end_step(heading));
}

bool was_measured(const Heading& heading, double from_s, double to_s) {
    if (heading.turned_rad.empty() || from_s < heading.start_s - heading.step_s ||
        to_s > end_s(heading) + 2 * heading.step_s) {
        return false;
    }
    const auto next = std::ranges::upper_bound(heading.silent, from_s, {}, &TimeSpan::to_s);
    return next == heading.silent.end() || next->from_s >= to_s;
}

// --------------------------------------------------------------------------------------- bias

/// Skips the middle of silences, where there are no values.
class SilenceSkipper {
public:
    explicit SilenceSkipper(const Heading& heading)
        : next_{heading.silent.begin()}, end_{heading.silent.end()} {}

    /// Returns the time itself; in a long silence, a time some whole steps later, shortly before
    /// its end.
    double after(double t_s, double step_s) {
        constexpr double looked_into_s = 10;
        while (next_ != end_ && next_->to_s <= t_s) {
            ++next_;
        }
        if (next_ == end_ || t_s < next_->from_s + looked_into_s) {
            return t_s;
        }
        const double steps = std::floor((next_->to_s - t_s) / step_s) - 1;
        return steps > 0 ? t_s + steps * step_s : t_s;
    }

private:
    std::vector<TimeSpan>::const_iterator next_;
    std::vector<TimeSpan>::const_iterator end_;
};

std::vector<BiasReading> standing_readings(const Heading& heading, const Odometer& odometer) {
    constexpr double left_m = 1; // travel over a silence that ends a stop
    SilenceSkipper skipper{heading};
    std::vector<BiasReading> readings;
    double from_s = unknown;
    const auto close = [&](double to_s) {
        const double took_s = to_s - from_s;
        if (took_s >= min_stand_s && was_measured(heading, from_s, to_s)) {
            const double radps = (turned_at(heading, to_s) - turned_at(heading, from_s)) / took_s;
            readings.push_back({(from_s + to_s) / 2,
                                radps,
                                stand_sd_radps * stand_sd_radps +
                                    noise_rad_per_sqrt_s * noise_rad_per_sqrt_s / took_s});
        }
        from_s = unknown;
    };
    const double step_s = 5 * heading.step_s;
    double before_radps = unknown;
    for (double t_s = heading.start_s; t_s + step_s <= end_s(heading); t_s += step_s) {
        const double radps = (turned_at(heading, t_s + step_s) - turned_at(heading, t_s)) / step_s;
        const bool stands = odometer.speed_mps(t_s) < standing_mps &&
                            !(std::abs(radps - before_radps) > quiet_radps);
        if (stands && std::isnan(from_s)) {
            from_s = t_s + step_s; // excludes the end of braking
        } else if (!stands && !std::isnan(from_s)) {
            close(t_s - step_s);
        }
        before_radps = radps;
        const double skipped_to_s = skipper.after(t_s, step_s);
        if (skipped_to_s > t_s &&
            odometer.travel_m(skipped_to_s) - odometer.travel_m(t_s) > left_m) {
            from_s = unknown;
        }
        t_s = skipped_to_s;
    }
    if (!std::isnan(from_s)) {
        close(end_s(heading));
    }
    return readings;
}

struct Course {
    double t_s;
    double rad; ///< positive to the left
    double sd_rad;
};

std::vector<Course> stated_courses(const TripLog& trip) {
    std::vector<Course> courses;
    for (const auto& fix : trip.fixes) {
        if (fix.speed_mps > static_cast<float>(course_from_mps) && !std::isnan(fix.course_deg)) {
            courses.push_back({fix.t_s - trip.meta.gnss_latency_s,
                               -static_cast<double>(fix.course_deg) * rad_per_deg,
                               course_sd_rad});
        }
    }
    return courses;
}

std::vector<Course> courses_of_chords(const TripLog& trip) {
    std::vector<Course> courses;
    for (const auto& chord : gnss_chords(trip, min_chord_m, longest_chord_s)) {
        if (chord.length_m > course_from_mps * (chord.to_s - chord.from_s)) {
            courses.push_back({(chord.from_s + chord.to_s) / 2 - trip.meta.gnss_latency_s,
                               chord.course_rad,
                               chord_sd_rad});
        }
    }
    return courses;
}

std::vector<Course> courses_of(const TripLog& trip) {
    auto courses = stated_courses(trip);
    return courses.size() * 4 > trip.fixes.size() ? courses : courses_of_chords(trip);
}

/// Returns the angular uncertainty of a course due to the uncertainty of its time stamp.
double blur_rad(const Heading& heading, double t_s, const TripMeta& meta) {
    const double rate_radps = turned_at(heading, t_s + 0.5) - turned_at(heading, t_s - 0.5);
    return rate_radps * (meta.gnss_latency_stated ? stated_latency_sd_s : unstated_latency_sd_s);
}

std::vector<BiasReading>
driving_readings(const Heading& heading, const std::vector<Course>& courses, const TripMeta& meta) {
    std::vector<BiasReading> readings;
    for (std::size_t from = 0, to = 0; to < courses.size(); ++to) {
        const auto& a = courses[from];
        const auto& b = courses[to];
        const double took_s = b.t_s - a.t_s;
        if (took_s < min_span_s) {
            continue;
        }
        from = to;
        if (took_s > max_span_s || !was_measured(heading, a.t_s, b.t_s)) {
            continue;
        }
        const double gyro_rad = turned_at(heading, b.t_s) - turned_at(heading, a.t_s);
        const double sd_rad = std::hypot(std::hypot(a.sd_rad, b.sd_rad),
                                         blur_rad(heading, a.t_s, meta),
                                         blur_rad(heading, b.t_s, meta));
        readings.push_back({(a.t_s + b.t_s) / 2,
                            wrapped(gyro_rad - (b.rad - a.rad)) / took_s,
                            sd_rad * sd_rad / (took_s * took_s)});
    }
    return readings;
}

/// Returns true if the gyro contradicts most courses.
bool is_contradicted(const Heading& heading,
                     const std::vector<Course>& courses,
                     const TripMeta& meta) {
    int compared = 0;
    int contradicting = 0;
    for (std::size_t from = 0, to = 0; to < courses.size(); ++to) {
        const auto& a = courses[from];
        const auto& b = courses[to];
        if (b.t_s - a.t_s < min_span_s) {
            continue;
        }
        from = to;
        if (b.t_s - a.t_s > max_span_s || !was_measured(heading, a.t_s, b.t_s)) {
            continue;
        }
        const double gyro_rad = turned_at(heading, b.t_s) - turned_at(heading, a.t_s);
        const double blurred_rad =
            std::abs(blur_rad(heading, a.t_s, meta)) + std::abs(blur_rad(heading, b.t_s, meta));
        const double off_rad = std::abs(wrapped(gyro_rad - (b.rad - a.rad)));
        ++compared;
        contradicting += off_rad > contradiction_rad + 3 * blurred_rad ? 1 : 0;
    }
    return contradicting > max_contradicting * compared;
}

} // namespace

std::vector<Heading::Run>::const_iterator run_at(const Heading& heading, double step) {
    const auto after = std::ranges::upper_bound(heading.runs, step, {}, [](const auto& run) {
        return static_cast<double>(run.first_step);
    });
    return after == heading.runs.begin() ? after : after - 1;
}

std::size_t size_of(const Heading& heading, std::vector<Heading::Run>::const_iterator run) {
    const auto next = run + 1;
    return (next == heading.runs.end() ? heading.turned_rad.size() : next->first) - run->first;
}

double turned_at(const Heading& heading, double t_s) {
    const double steps = std::clamp(
        (t_s - heading.start_s) / heading.step_s, 0.0, static_cast<double>(end_step(heading)));
    const auto run = run_at(heading, steps);
    const auto last = size_of(heading, run) - 1;
    const double into = steps - static_cast<double>(run->first_step);
    const auto i = std::min(static_cast<std::size_t>(into), last);
    const auto next = std::min(run->first + i + 1, heading.turned_rad.size() - 1);
    const double step = i < last || run + 1 == heading.runs.end()
                            ? 1
                            : static_cast<double>((run + 1)->first_step - run->first_step) -
                                  static_cast<double>(last); // the silence
    return std::lerp(static_cast<double>(heading.turned_rad[run->first + i]),
                     static_cast<double>(heading.turned_rad[next]),
                     (into - static_cast<double>(i)) / step);
}

Turn turned(const Heading& heading, double from_s, double to_s) {
    if (!was_measured(heading, from_s, to_s)) {
        return {0, std::numeric_limits<double>::infinity()};
    }
    const double rad = turned_at(heading, to_s) - turned_at(heading, from_s);
    const double took_s = to_s - from_s;
    return {rad,
            std::hypot(std::hypot(min_sd_rad, noise_rad_per_sqrt_s * std::sqrt(took_s)),
                       heading.bias_sd_radps * took_s,
                       scale_sd * rad)};
}

Heading make_heading(const TripLog& trip, const Odometer& odometer, const Mounting& mounting) {
    auto heading = integrated(trip, mounting);
    if (heading.turned_rad.size() < 2) {
        return {};
    }
    const auto courses = courses_of(trip);
    auto readings = standing_readings(heading, odometer);
    std::ranges::copy(driving_readings(heading, courses, trip.meta), std::back_inserter(readings));
    heading = without_gyro_bias(std::move(heading), std::move(readings));
    return is_contradicted(heading, courses, trip.meta) ? Heading{} : heading;
}

} // namespace macadam
