#include "estimator/clocks/clock_offset.hpp"

#include "estimator/common/angle.hpp"

#include <Eigen/Dense>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

namespace macadam {

namespace {

constexpr double min_grid_s = 0.05;
constexpr std::size_t max_grid = std::size_t{1} << 20; // 14 h at 0.05 s
constexpr double coarse_step_s = 0.5; // a receiver's step of 1 s is the width of a peak
constexpr double fine_step_s = 0.05;
constexpr double min_fix_step_s = 0.95;
constexpr double max_fix_step_s = 5.5; // of loggers that thin out a straight drive
constexpr std::size_t max_steps = 3600;
constexpr std::size_t min_steps = 30;
constexpr double min_overlap_s = 60;
constexpr double min_turning_mps = 3; // below, courses are noise
constexpr double max_sensor_gap_s = 0.5;
constexpr double max_speed_gap_s = 2.5; // wheel speed from a diagnostic port comes at 1 Hz
constexpr double same_peak_s = 3;
constexpr double correlated_steps = 4; // that count as one: drivers brake and turn for seconds
constexpr double min_evidence = 12;    // log likelihood over no relation; unrelated drives reach 10
constexpr double min_margin = 8;       // over the next peak
constexpr double min_sd_s = 0.1;       // real receivers smooth their speeds
constexpr std::size_t tried_peaks = 6;

/// Step from one fix to a later one.
struct Step {
    double from_s;
    double to_s;
    double faster_mps;
    double left_rad; ///< NaN: unknown
    double left_mps; ///< turn times speed: the integral of lateral acceleration
};

struct SpeedSample {
    double t_s;
    double speed_mps;
    double course_rad; ///< NaN: unknown
};

/// Speeds and courses at the fixes, or, where the receiver gives none, from chord to chord.
std::vector<SpeedSample> speeds_of(const std::vector<GnssFix>& fixes) {
    std::vector<SpeedSample> samples;
    const GnssFix* last = nullptr;
    const auto course = [](double speed_mps, double deg) {
        return speed_mps >= min_turning_mps ? deg * rad_per_deg
                                            : std::numeric_limits<double>::quiet_NaN();
    };
    for (const auto& fix : fixes) {
        if (last != nullptr && fix.t_s - last->t_s < min_fix_step_s) {
            continue;
        }
        const auto speed_mps = static_cast<double>(fix.speed_mps);
        if (std::isfinite(speed_mps)) {
            samples.push_back({fix.t_s, speed_mps, course(speed_mps, fix.course_deg)});
        } else if (last != nullptr && std::isfinite(distance_m(last->at, fix.at))) {
            const double mean_mps = distance_m(last->at, fix.at) / (fix.t_s - last->t_s);
            samples.push_back({(last->t_s + fix.t_s) / 2,
                               mean_mps,
                               course(mean_mps, course_deg(last->at, fix.at))});
        }
        last = &fix;
    }
    return samples;
}

std::vector<Step> steps_of(const std::vector<GnssFix>& fixes) {
    const auto samples = speeds_of(fixes);
    std::vector<Step> steps;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const auto& [from_s, from_mps, from_rad] = samples[i - 1];
        const auto& [to_s, to_mps, to_rad] = samples[i];
        if (to_s - from_s <= max_fix_step_s && to_s > from_s) {
            const double left_rad = std::remainder(from_rad - to_rad, 2 * std::numbers::pi);
            steps.push_back(
                {from_s, to_s, to_mps - from_mps, left_rad, left_rad * (from_mps + to_mps) / 2});
        }
    }
    if (steps.size() > max_steps) { // evenly thinned out
        std::vector<Step> kept;
        for (std::size_t i = 0; i < max_steps; ++i) {
            kept.push_back(steps[i * steps.size() / max_steps]);
        }
        return kept;
    }
    return steps;
}

/// Integrals of a sensor, or its readings, on an even grid; no value across gaps.
class Grid {
public:
    /// \param integrate  the readings; otherwise they are taken as they are
    Grid(const std::vector<double>& t_s,
         std::array<std::span<const float>, 3> readings,
         bool integrate,
         double max_gap_s) {
        if (t_s.size() < 2) {
            return;
        }
        begin_s_ = t_s.front();
        const double length_s = t_s.back() - begin_s_;
        step_s_ = std::max(min_grid_s, length_s / static_cast<double>(max_grid));
        const auto count = static_cast<std::size_t>(length_s / step_s_) + 1;
        values_.resize(count);
        gaps_.resize(count);
        std::array<double, 3> at_reading{}; // value at t_s[i]
        std::size_t i = 0;
        std::uint32_t gaps = 0;
        for (std::size_t node = 0; node < count; ++node) {
            const double node_s = begin_s_ + static_cast<double>(node) * step_s_;
            while (i + 2 < t_s.size() && t_s[i + 1] <= node_s) {
                gaps += t_s[i + 1] - t_s[i] > max_gap_s ? 1U : 0U;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    at_reading[axis] += area(readings[axis], t_s, i, t_s[i + 1]);
                }
                ++i;
            }
            const bool inside = t_s[i + 1] - t_s[i] > max_gap_s && node_s > t_s[i];
            gaps_[node] = 2 * gaps + (inside ? 1U : 0U);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                values_[node][axis] = integrate
                                          ? at_reading[axis] + area(readings[axis], t_s, i, node_s)
                                          : reading_at(readings[axis], t_s, i, node_s);
            }
        }
    }

    bool empty() const { return values_.empty(); }
    double length_s() const { return static_cast<double>(values_.size()) * step_s_; }
    double begin_s() const { return begin_s_; }

    /// Change of the values from one time to another; false across gaps and beyond the ends.
    bool change(double from_s, double to_s, std::array<double, 3>& by) const {
        const double a = (from_s - begin_s_) / step_s_;
        const double b = (to_s - begin_s_) / step_s_;
        if (!(a >= 0) || !(b + 1 < static_cast<double>(values_.size())) || !(b > a)) {
            return false;
        }
        const auto i = static_cast<std::size_t>(a);
        const auto j = static_cast<std::size_t>(b);
        if (gaps_[i] != gaps_[j + 1] || gaps_[i] % 2 != 0) {
            return false;
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            by[axis] = std::lerp(values_[j][axis], values_[j + 1][axis], b - std::floor(b)) -
                       std::lerp(values_[i][axis], values_[i + 1][axis], a - std::floor(a));
        }
        return true;
    }

private:
    static double known(std::span<const float> readings, std::size_t i) {
        return i < readings.size() && std::isfinite(readings[i]) ? static_cast<double>(readings[i])
                                                                 : 0.0;
    }
    static double reading_at(std::span<const float> readings,
                             const std::vector<double>& t_s,
                             std::size_t i,
                             double at_s) {
        const double share = (at_s - t_s[i]) / (t_s[i + 1] - t_s[i]);
        return std::lerp(known(readings, i), known(readings, i + 1), std::clamp(share, 0.0, 1.0));
    }
    /// From reading i to a time before the next.
    static double area(std::span<const float> readings,
                       const std::vector<double>& t_s,
                       std::size_t i,
                       double to_s) {
        return (known(readings, i) + reading_at(readings, t_s, i, to_s)) / 2 * (to_s - t_s[i]);
    }

    double begin_s_ = 0;
    double step_s_ = 1;
    std::vector<std::array<double, 3>> values_;
    std::vector<std::uint32_t> gaps_; ///< passed, times 2; odd within one
};

/// Sums of a linear regression through a bias that grows with time.
class Regression {
public:
    void add(double target, double step_s, const std::array<double, 3>& changes) {
        const Eigen::Vector4d x{step_s, changes[0], changes[1], changes[2]};
        products_ += x * x.transpose();
        with_target_ += x * target;
        squares_ += target * target;
        ++count_;
    }

    std::size_t count() const { return count_; }

    /// Log likelihood over that of the bias alone.
    double evidence() const {
        if (count_ < min_steps || !(squares_ > 0)) {
            return 0;
        }
        const double by_bias =
            products_(0, 0) > 0 ? with_target_(0) * with_target_(0) / products_(0, 0) : 0;
        Eigen::Matrix4d ridged = products_;
        ridged.diagonal() += Eigen::Vector4d::Constant(1e-9 * products_.trace() + 1e-12);
        const double explained = with_target_.dot(ridged.ldlt().solve(with_target_));
        const double without = squares_ - by_bias;
        const double with = std::max(squares_ - explained, 1e-4 * squares_);
        return without > with
                   ? static_cast<double>(count_) / (2 * correlated_steps) * std::log(without / with)
                   : 0;
    }

private:
    Eigen::Matrix4d products_ = Eigen::Matrix4d::Zero();
    Eigen::Vector4d with_target_ = Eigen::Vector4d::Zero();
    double squares_ = 0;
    std::size_t count_ = 0;
};

/// Log likelihood of offsets.
class Likelihood {
public:
    Likelihood(const TripLog& log, std::vector<Step> steps)
        : steps_{std::move(steps)}, acc_{log.acc.t_s,
                                         {log.acc.x, log.acc.y, log.acc.z},
                                         true,
                                         max_sensor_gap_s},
          gyro_{log.gyro.t_s, {log.gyro.x, log.gyro.y, log.gyro.z}, true, max_sensor_gap_s},
          speed_{log.speed.t_s, {log.speed.speed_mps, {}, {}}, false, max_speed_gap_s} {
        double begin_s = std::numeric_limits<double>::infinity();
        double end_s = -begin_s;
        for (const auto* const grid : {&acc_, &gyro_, &speed_}) {
            if (!grid->empty()) {
                begin_s = std::min(begin_s, grid->begin_s());
                end_s = std::max(end_s, grid->begin_s() + grid->length_s());
            }
        }
        begin_s_ = begin_s;
        end_s_ = end_s;
        double summed_s = 0;
        for (const auto& step : steps_) {
            summed_s += step.to_s - step.from_s;
        }
        const double mean_s = summed_s / static_cast<double>(steps_.size());
        const double shorter_s = std::min(summed_s, end_s - begin_s);
        needed_ = std::max(
            {min_steps, static_cast<std::size_t>(std::max(min_overlap_s, shorter_s / 2) / mean_s)});
    }

    bool has_sensors() const { return !(acc_.empty() && gyro_.empty() && speed_.empty()); }
    double first_s() const { return begin_s_ - steps_.back().to_s; }
    double last_s() const { return end_s_ - steps_.front().from_s; }

    /// 0 where too little overlaps.
    double operator()(double offset_s) const {
        Regression by_wheels;
        Regression by_acc;
        Regression lateral;
        Regression by_gyro;
        std::array<double, 3> change{};
        std::size_t overlap = 0;
        for (const auto& step : steps_) {
            const double from_s = step.from_s + offset_s;
            const double to_s = step.to_s + offset_s;
            const double length_s = to_s - from_s;
            bool any = false;
            if (acc_.change(from_s, to_s, change)) {
                any = true;
                by_acc.add(step.faster_mps, length_s, change);
                if (!std::isnan(step.left_mps)) {
                    lateral.add(step.left_mps, length_s, change);
                }
            }
            if (speed_.change(from_s, to_s, change)) {
                any = true;
                by_wheels.add(step.faster_mps, length_s, change);
            }
            if (gyro_.change(from_s, to_s, change)) {
                any = true;
                if (!std::isnan(step.left_rad)) {
                    by_gyro.add(step.left_rad, length_s, change);
                }
            }
            overlap += any ? 1U : 0U;
        }
        // The two regressions of one quantity are not independent: the better one counts.
        return overlap < needed_ ? 0
                                 : std::max(by_wheels.evidence(), by_acc.evidence()) +
                                       std::max(lateral.evidence(), by_gyro.evidence());
    }

private:
    std::vector<Step> steps_;
    Grid acc_;
    Grid gyro_;
    Grid speed_;
    double begin_s_;
    double end_s_;
    std::size_t needed_ = 0;
};

struct Peak {
    double offset_s;
    double evidence;
};

/// Highest peaks of the coarse search, at least `same_peak_s` apart.
std::vector<Peak> coarse_peaks(const Likelihood& likelihood, const std::stop_token& stop) {
    std::vector<Peak> all;
    const double first_s = likelihood.first_s();
    const auto count =
        static_cast<std::size_t>((likelihood.last_s() - first_s) / coarse_step_s) + 1;
    for (std::size_t i = 0; i < count && !stop.stop_requested(); ++i) {
        const double offset_s = first_s + static_cast<double>(i) * coarse_step_s;
        all.push_back({offset_s, likelihood(offset_s)});
    }
    std::ranges::sort(all, std::ranges::greater{}, &Peak::evidence);
    std::vector<Peak> peaks;
    for (const auto& point : all) {
        const bool is_new = std::ranges::none_of(peaks, [&](const Peak& peak) {
            return std::abs(peak.offset_s - point.offset_s) <= same_peak_s;
        });
        if (is_new && peaks.size() < tried_peaks) {
            peaks.push_back(point);
        }
    }
    return peaks;
}

Peak refined(const Likelihood& likelihood, const Peak& peak) {
    auto best = peak;
    const auto count = static_cast<int>(std::lround(2 * coarse_step_s / fine_step_s));
    for (int i = -count; i <= count; ++i) {
        const double offset_s = peak.offset_s + i * fine_step_s;
        const double evidence = likelihood(offset_s);
        best = evidence > best.evidence ? Peak{offset_s, evidence} : best;
    }
    return best;
}

/// Vertex and standard deviation from the parabola through the peak and its surroundings.
ClockOffset vertex_of(const Likelihood& likelihood, const Peak& peak) {
    constexpr double aside_s = 4 * fine_step_s;
    const double before = likelihood(peak.offset_s - aside_s);
    const double after = likelihood(peak.offset_s + aside_s);
    const double bend = (2 * peak.evidence - before - after) / (aside_s * aside_s);
    if (!(bend > 0)) {
        return {peak.offset_s, aside_s};
    }
    const double beside_s = (after - before) / (2 * aside_s * bend);
    return {peak.offset_s + std::clamp(beside_s, -aside_s, aside_s),
            std::max(min_sd_s, 1 / std::sqrt(bend))};
}

} // namespace

ClockOffsetSearch find_clock_offset(const TripLog& log,
                                    const std::vector<GnssFix>& fixes,
                                    const std::stop_token& stop) {
    constexpr double longest_s = 200000; // two days; a wild stamp makes a recording longer
    auto steps = steps_of(fixes);
    if (steps.size() < min_steps) {
        return {.found = {}, .words = "the positions are too few or too far apart in time"};
    }
    const Likelihood likelihood{log, std::move(steps)};
    if (!likelihood.has_sensors()) {
        return {.found = {}, .words = "the log has neither speed, acceleration nor rates of turn"};
    }
    if (likelihood.last_s() - likelihood.first_s() > longest_s) {
        return {.found = {}, .words = "the times span more than two days"};
    }
    auto peaks = coarse_peaks(likelihood, stop);
    for (auto& peak : peaks) {
        peak = refined(likelihood, peak);
    }
    std::ranges::sort(peaks, std::ranges::greater{}, &Peak::evidence);
    if (peaks.empty() || peaks.front().evidence < min_evidence) {
        return {.found = {},
                .words = "no offset makes speeds and turns agree with the sensors for at least a "
                         "minute and half of the shorter recording; are both of one drive?"};
    }
    if (peaks.size() > 1 && peaks[0].evidence - peaks[1].evidence < min_margin) {
        return {.found = {},
                .words = fmt::format("offsets of {:.1f} s and {:.1f} s fit about as well",
                                     peaks[0].offset_s,
                                     peaks[1].offset_s)};
    }
    return {.found = vertex_of(likelihood, peaks.front()), .words = ""};
}

} // namespace macadam
