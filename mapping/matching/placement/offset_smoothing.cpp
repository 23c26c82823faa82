#include "mapping/matching/placement/offset_smoothing.hpp"

#include "mapping/matching/placement/position_smoother.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr double min_step_s = 0.95; // errors of closer fixes are correlated
constexpr double slow_step_s = 5;   // the same if the car hardly moved
constexpr double new_way_m = 4;
constexpr double max_step_m = 15;     // without a knot, where travel is measured
constexpr double min_between_s = 0.3; // limits the knots for cars up to 180 km/h
constexpr double min_step_m = 0.05;   // a car that moved less is still standing
constexpr double heading_half_m = 8;
constexpr double gyro_step_m = 2;
constexpr double bias_alike_s = 30;     // correlation time of the residual gyro bias
constexpr double silence_variance = 10; // of the heading after a gap: unconstrained
constexpr double longest_beyond_m = 40; // of noise beyond the end of a road; more is a gap
constexpr double fade = 5;              // so that the position still increases with travel

/// Integrates the gyro's turn over travel, as far as requested.
class GyroTrack {
public:
    /// \param from_m  lower bound of all requests.
    GyroTrack(const Heading& heading, const Odometer& odometer, double from_m)
        : heading_{heading}, odometer_{odometer}, from_m_{from_m}, last_rad_{turned_at(
                                                                       heading,
                                                                       odometer.t_s(from_m))} {}

    /// Returns the mean over heading_half_m on both sides; `std::nullopt` if not all of it was
    /// measured.
    ///
    /// \param travel_m  not before that of an earlier call.
    std::optional<double> mean_rad(double travel_m) {
        const double low_m = travel_m - heading_half_m;
        const double high_m = travel_m + heading_half_m;
        const auto turn = turned(heading_, odometer_.t_s(low_m), odometer_.t_s(high_m));
        if (std::isinf(turn.sd_rad)) {
            return std::nullopt;
        }
        const auto first = step_at(low_m);
        if (first > first_ + sums_.size() + max_summed) {
            begin(first);
        }
        while (sums_.size() <= step_at(high_m) + 1 - first_) {
            go_on();
        }
        if (first - first_ > max_summed) {
            forget_before(first);
        }
        return (sum_at(high_m) - sum_at(low_m)) / (high_m - low_m);
    }

private:
    static constexpr std::size_t max_summed = 1000; // steps discarded at once

    std::size_t step_at(double travel_m) const {
        return static_cast<std::size_t>(std::max(0.0, (travel_m - from_m_) / gyro_step_m));
    }

    double rad_at(std::size_t step) const {
        const double at_m = from_m_ + gyro_step_m * static_cast<double>(step);
        return turned_at(heading_, odometer_.t_s(at_m));
    }

    void begin(std::size_t step) {
        first_ = step;
        sums_.assign(1, 0);
        last_rad_ = rad_at(step);
    }

    void go_on() {
        const double rad = rad_at(first_ + sums_.size());
        sums_.push_back(sums_.back() + gyro_step_m * (last_rad_ + rad) / 2);
        last_rad_ = rad;
    }

    void forget_before(std::size_t step) {
        sums_.erase(sums_.begin(), sums_.begin() + static_cast<std::ptrdiff_t>(step - first_));
        first_ = step;
    }

    double sum_at(double travel_m) const {
        const double steps = std::max(0.0, (travel_m - from_m_) / gyro_step_m);
        const auto i = static_cast<std::size_t>(steps);
        return std::lerp(sums_[i - first_], sums_[i + 1 - first_], steps - static_cast<double>(i));
    }

    const Heading& heading_;
    const Odometer& odometer_;
    double from_m_;
    std::size_t first_ = 0;       ///< step of the first of the sums
    std::vector<double> sums_{0}; ///< of the turn over travel, one per step
    double last_rad_;             ///< at the last of the sums
};

/// Returns the variance of the gyro's drift between two epochs.
double strayed_variance(const Heading& heading, const Epoch& from, const Epoch& to) {
    const auto turn = turned(heading, from.t_s, to.t_s);
    const double bias = heading.bias_sd_radps;
    return std::isinf(turn.sd_rad)
               ? silence_variance
               : turn.sd_rad * turn.sd_rad + bias_alike_s * bias * bias * (to.t_s - from.t_s);
}

/// Divides the measured travel between two fixes into steps.
std::vector<Epoch> epochs_between(const Epoch& from, const Epoch& to, const Odometer& odometer) {
    const double gone_m = to.travel_m - from.travel_m;
    const double steps =
        std::ceil(std::min(gone_m / max_step_m, (to.t_s - from.t_s) / min_between_s));
    std::vector<Epoch> between;
    for (double i = 1; i < steps; ++i) {
        const double travel_m = from.travel_m + gone_m * i / steps;
        between.push_back({.t_s = odometer.t_s(travel_m),
                           .travel_m = travel_m,
                           .speed_mps = 0,
                           .measured = true,
                           .fix = std::nullopt,
                           .fix_sd_m = to.fix_sd_m,
                           .gyro_rad = std::nullopt});
    }
    return between;
}

/// Builds the epochs of a path: its fixes, thinned if in quick succession, and the steps in
/// between.
std::vector<Epoch>
epochs_of(const RoadPath& path, const MatchObservations& positions, const Odometer& odometer) {
    std::vector<Epoch> epochs;
    const auto last = path.positions.back();
    for (auto i = path.positions.front(); i <= last; ++i) {
        const auto& position = positions.all[i];
        const bool first = epochs.empty();
        const double took_s = first ? 0 : position.t_s - epochs.back().t_s;
        const double gone_m = first ? 0 : position.travel_m - epochs.back().travel_m;
        const bool idle = position.dead_reckoned || took_s < min_step_s ||
                          (gone_m < new_way_m && took_s < slow_step_s);
        if (!first && idle && i != last) {
            continue;
        }
        const double known_mps = odometer.speed_mps(position.t_s - took_s / 2);
        const double speed_mps = odometer.speed_mps(position.t_s);
        const double mean_mps = took_s > 0 ? gone_m / took_s : 0;
        const Epoch epoch{.t_s = position.t_s,
                          .travel_m = position.travel_m,
                          .speed_mps = std::isnan(speed_mps) ? mean_mps : speed_mps,
                          .measured = positions.odometer && !std::isnan(known_mps),
                          .fix = position.dead_reckoned ? std::nullopt : std::optional{position.at},
                          .fix_sd_m = static_cast<double>(position.own_sd_m),
                          .gyro_rad = std::nullopt};
        if (!first && epoch.measured) {
            const auto between = epochs_between(epochs.back(), epoch, odometer);
            epochs.insert(epochs.end(), between.begin(), between.end());
        }
        epochs.push_back(epoch);
    }
    return epochs;
}

std::vector<Epoch>
with_gyro(std::vector<Epoch> epochs, const Heading& heading, const Odometer& odometer) {
    if (heading.turned_rad.empty()) {
        return epochs;
    }
    GyroTrack gyro{heading, odometer, epochs.front().travel_m - heading_half_m};
    for (std::size_t k = 0; k < epochs.size(); ++k) {
        epochs[k].gyro_rad = gyro.mean_rad(epochs[k].travel_m);
        epochs[k].heading_variance =
            k > 0 ? strayed_variance(heading, epochs[k - 1], epochs[k]) : 0;
    }
    return epochs;
}

/// Returns approximate driven lengths of the epochs: linear over travel between samples.
std::vector<double> nominal_places(const std::vector<Epoch>& epochs,
                                   const RoadPath& path,
                                   const MatchObservations& positions,
                                   const SmoothedPath& line) {
    const auto travel_m = [&](std::size_t sample) {
        return positions.all[path.positions[sample]].travel_m;
    };
    std::vector<double> nominal_m;
    std::size_t sample = 0; // at or before the epoch
    const auto count = path.positions.size();
    for (const auto& epoch : epochs) {
        while (sample + 2 < count && travel_m(sample + 1) <= epoch.travel_m) {
            ++sample;
        }
        const auto next = std::min(sample + 1, count - 1);
        const double gap_m = travel_m(next) - travel_m(sample);
        const double share = gap_m > 0 ? (epoch.travel_m - travel_m(sample)) / gap_m : 0;
        nominal_m.push_back(std::lerp(driven_m_at(line, path.sample_m[sample]),
                                      driven_m_at(line, path.sample_m[next]),
                                      std::clamp(share, 0.0, 1.0)));
    }
    return nominal_m;
}

/// Corrects noise that moves an end of a trip slightly beyond the end of its path: removes
/// `beyond_m` entirely at the end `at_m` and gradually less along the path from there.
std::vector<PathSample> pulled_in(std::vector<PathSample> knots, double at_m, double beyond_m) {
    if (beyond_m == 0 || std::abs(beyond_m) > longest_beyond_m) {
        return knots;
    }
    const double fade_m = fade * std::abs(beyond_m);
    for (auto& knot : knots) {
        knot.along_m -= beyond_m * std::max(0.0, 1 - std::abs(knot.travel_m - at_m) / fade_m);
    }
    return knots;
}

} // namespace

std::vector<PathSample> smoothed_knots(const RoadPath& path,
                                       const RoadNetwork& roads,
                                       CandidateIndex& plane,
                                       const MatchObservations& positions,
                                       const Odometer& odometer) {
    const auto line = driven_line(path, roads, plane);
    if (line.at.size() < 2) {
        return {};
    }
    const auto epochs =
        with_gyro(epochs_of(path, positions, odometer), *positions.heading, odometer);
    const auto placed = smoothed_places(line,
                                        epochs,
                                        nominal_places(epochs, path, positions, line),
                                        {.latency_sd_s = positions.latency_sd_s,
                                         .scale_sd = positions.odometer ? 0.01 : 1e-4,
                                         .heading_half_m = heading_half_m});
    std::vector<PathSample> knots;
    for (std::size_t k = 0; k < epochs.size(); ++k) {
        const double along_m = along_m_at(line, placed[k].driven_m);
        if (knots.empty() || epochs[k].travel_m - knots.back().travel_m > min_step_m) {
            knots.push_back({epochs[k].travel_m,
                             knots.empty() ? along_m : std::max(knots.back().along_m, along_m),
                             placed[k].sd_m});
        }
    }
    const double before_m = std::min(0.0, knots.front().along_m);
    const double beyond_m = std::max(0.0, knots.back().along_m - length_m(path));
    const double end_m = knots.back().travel_m;
    return pulled_in(
        pulled_in(std::move(knots), epochs.front().travel_m, before_m), end_m, beyond_m);
}

} // namespace macadam
