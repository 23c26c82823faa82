#include "estimator/clocks/turn_latency.hpp"

#include "estimator/common/angle.hpp"
#include "estimator/common/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace macadam {
namespace {

using Complex = std::complex<double>;

constexpr double min_way_m = 5;        // shorter chords have no reliable course
constexpr double longest_way_s = 6;    // the speed within is not known
constexpr std::size_t neighbours = 25; // on either side, for the zero direction of the gyro
constexpr std::size_t min_ways = 30;   // fewer may agree by chance
constexpr double degrees = 4;          // degrees of freedom of the t distribution
constexpr double quartile = 0.741;     // of t with these degrees of freedom
constexpr double independent = 0.75;   // share of the chords, since neighbours have a fix in common
constexpr double min_spread_m = 0.1;

/// Chord from one fix to another.
struct Way {
    double from_s; ///< time stamps
    double to_s;
    Complex to_m;      ///< east and north
    double gain_per_s; ///< acceleration relative to the speed
};

std::vector<Way> ways_of(const TripLog& trip) {
    std::vector<Way> ways;
    const GnssFix* from = nullptr;
    for (const auto& fix : trip.fixes) {
        if (from == nullptr || fix.t_s - from->t_s > longest_way_s) {
            from = &fix;
            continue;
        }
        const double way_m = distance_m(from->at, fix.at);
        if (way_m >= min_way_m) {
            const double rad = course_deg(from->at, fix.at) * rad_per_deg;
            ways.push_back({from->t_s, fix.t_s, std::polar(way_m, std::numbers::pi / 2 - rad), 0});
            from = &fix;
        }
    }
    return ways;
}

double speed_mps(const Way& way) {
    return std::abs(way.to_m) / (way.to_s - way.from_s);
}

/// Adds the relative acceleration from the previous and the next chord: cars brake into corners and
/// accelerate out of them.
std::vector<Way> with_gains(std::vector<Way> ways) {
    constexpr double most = 1.5; // of the speed, from one end of a chord to the other
    for (std::size_t i = 1; i + 1 < ways.size(); ++i) {
        const auto& before = ways[i - 1];
        const auto& after = ways[i + 1];
        auto& way = ways[i];
        if (before.to_s != way.from_s || way.to_s != after.from_s) {
            continue;
        }
        const double apart_s = (after.from_s + after.to_s - before.from_s - before.to_s) / 2;
        const double gain_mps2 = (speed_mps(after) - speed_mps(before)) / apart_s;
        const double limit = most / (way.to_s - way.from_s);
        way.gain_per_s = std::clamp(gain_mps2 / speed_mps(way), -limit, limit);
    }
    return ways;
}

/// Integral over time of the direction given by the gyro, so that any time mean has constant cost.
class Directions {
public:
    explicit Directions(const Heading& heading) : heading_{heading} {
        Sums sums{0, 0};
        sums_.reserve(heading.turned_rad.size());
        for (auto run = heading.runs.begin(); run != heading.runs.end(); ++run) {
            const auto size = size_of(heading, run);
            for (std::size_t i = 0; i < size; ++i) {
                sums_.push_back(sums);
                const auto ahead = std::polar(
                    heading.step_s, static_cast<double>(heading.turned_rad[run->first + i]));
                const auto step = run->first_step + static_cast<std::int64_t>(i);
                sums.plain += ahead;
                sums.timed += ahead * (heading.step_s * static_cast<double>(step));
            }
        }
    }

    /// Returns the sum over a measured time, weighted by 1 + gain_per_s (t - middle).
    Complex sum(double from_s, double to_s, double gain_per_s) const {
        const auto from = at(from_s);
        const auto to = at(to_s);
        const double middle_s = (from_s + to_s) / 2 - heading_.start_s;
        return (to.plain - from.plain) * (1 - gain_per_s * middle_s) +
               (to.timed - from.timed) * gain_per_s;
    }

private:
    struct Sums {
        Complex plain;
        Complex timed;
    };

    Sums at(double t_s) const {
        // A sample represents half a step before and after it.
        const double steps = (t_s - heading_.start_s) / heading_.step_s + 0.5;
        const auto run = run_at(heading_, steps);
        const auto last = std::min(run->first + size_of(heading_, run), sums_.size() - 1);
        const double into = std::clamp(steps - static_cast<double>(run->first_step),
                                       0.0,
                                       static_cast<double>(last - run->first));
        const auto i = std::min(run->first + static_cast<std::size_t>(into), sums_.size() - 2);
        const double share = into - (static_cast<double>(i) - static_cast<double>(run->first));
        return {sums_[i].plain + share * (sums_[i + 1].plain - sums_[i].plain),
                sums_[i].timed + share * (sums_[i + 1].timed - sums_[i].timed)};
    }

    const Heading& heading_;
    std::vector<Sums> sums_;
};

/// Returns sequences of consecutive chords for which the gyro was measured at all lags.
std::vector<std::vector<Way>>
seen_runs(const std::vector<Way>& ways, const Heading& heading, double longest_lag_s) {
    std::vector<std::vector<Way>> runs;
    double last_s = 0;
    for (const auto& way : ways) {
        if (std::isinf(turned(heading, way.from_s - longest_lag_s, way.to_s).sd_rad)) {
            continue;
        }
        if (runs.empty() || way.from_s - last_s > longest_way_s) {
            runs.emplace_back();
        }
        runs.back().push_back(way);
        last_s = way.to_s;
    }
    return runs;
}

/// Adds the lateral deviation of each chord from the gyro's path.
void add_asides(std::vector<double>& asides_m,
                const std::vector<Way>& run,
                const Directions& directions,
                double lag_s) {
    std::vector<Complex> off; // length squared, and the angle from the gyro to the chord
    std::vector<Complex> sums{0};
    for (const auto& way : run) {
        const auto drawn = directions.sum(way.from_s - lag_s, way.to_s - lag_s, way.gain_per_s);
        const double size = std::abs(drawn);
        off.push_back(size > 0 ? std::abs(way.to_m) * way.to_m * std::conj(drawn) / size : 0);
        sums.push_back(sums.back() + off.back());
    }
    for (std::size_t i = 0; i < run.size(); ++i) {
        const auto low = i - std::min(i, neighbours);
        const auto high = std::min(i + neighbours + 1, run.size());
        const auto zero = sums[high] - sums[low];
        asides_m.push_back(std::abs(run[i].to_m) * std::arg(off[i] * std::conj(zero)));
    }
}

double median_size(std::vector<double> values) {
    std::ranges::transform(values, values.begin(), [](double a) { return std::abs(a); });
    return median(std::move(values));
}

/// Returns the cost under Student's t, scaled so that half of the values lie within the median.
double cost_of(const std::vector<double>& values, double median) {
    const double spread = std::max(median / quartile, min_spread_m);
    double sum = 0;
    for (const double value : values) {
        const double sds = value / spread;
        sum += std::log1p(sds * sds / degrees);
    }
    return independent * (degrees + 1) / 2 * sum;
}

} // namespace

std::vector<double>
turn_latency_costs(const TripLog& trip, const Heading& heading, const std::vector<double>& lags_s) {
    std::vector<double> costs(lags_s.size(), 0.0);
    if (heading.turned_rad.size() < 2 || lags_s.empty()) {
        return costs;
    }
    const auto runs =
        seen_runs(with_gains(ways_of(trip)), heading, *std::ranges::max_element(lags_s));
    const Directions directions{heading};
    std::vector<std::vector<double>> asides_m(lags_s.size());
    for (std::size_t i = 0; i < lags_s.size(); ++i) {
        for (const auto& run : runs) {
            add_asides(asides_m[i], run, directions, lags_s[i]);
        }
    }
    if (asides_m.front().size() < min_ways) {
        return costs;
    }
    std::vector<double> medians(lags_s.size());
    std::ranges::transform(asides_m, medians.begin(), median_size);
    const double median = *std::ranges::min_element(medians);
    std::ranges::transform(asides_m, costs.begin(), [=](const std::vector<double>& values) {
        return cost_of(values, median);
    });
    return costs;
}

} // namespace macadam
