#include "estimator/identification/likelihood/station_shift.hpp"

#include "estimator/motion/butterworth.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

constexpr double from_hz = 0.7;
constexpr double to_hz = 5; // waves of 3 m at 15 m/s: no match on the wrong one within a metre
constexpr int filter_order = 4;
constexpr double settle_s = 3;
constexpr double reach_m = 50;       // of the window around a knot
constexpr double min_window_m = 25;  // shorter pieces, at the ends of a drive, match anywhere
constexpr double search_m = 4;       // of the first match
constexpr double max_change_m = 1.5; // from knot to knot: 3 % of the travel between them

std::vector<double> banded(std::span<const double> signal, double step_s) {
    const auto settle = static_cast<std::size_t>(settle_s / step_s);
    const auto low =
        zero_phase(butterworth_lowpass(filter_order, to_hz, 1 / step_s), signal, settle);
    return zero_phase(butterworth_highpass(filter_order, from_hz, 1 / step_s), low, settle);
}

struct Match {
    double shift_m = 0;
    double correlation = -1;
};

/// Correlates the samples around one knot at all lags within some metres of a shift.
class Correlator {
public:
    Correlator(std::span<const double> station_m,
               std::vector<double> measured,
               std::vector<double> modelled)
        : station_m_{station_m}, measured_{std::move(measured)}, modelled_{std::move(modelled)} {}

    /// Returns no match if the window holds too little of the drive.
    Match best(double knot_m, double about_m, double within_m) const {
        const auto from = index_of(knot_m - reach_m);
        const auto to = index_of(knot_m + reach_m);
        Match best;
        if (to < from + 2 || station_m_[to - 1] - station_m_[from] < min_window_m) {
            return best;
        }
        const auto middle = (from + to) / 2;
        const double pace_m =
            (station_m_[to - 1] - station_m_[from]) / static_cast<double>(to - 1 - from);
        const auto low = static_cast<std::ptrdiff_t>(std::floor((about_m - within_m) / pace_m));
        const auto high = static_cast<std::ptrdiff_t>(std::ceil((about_m + within_m) / pace_m));
        for (std::ptrdiff_t lag = low; lag <= high; ++lag) {
            const double correlation = at_lag(from, to, lag);
            if (correlation > best.correlation) {
                const auto other =
                    std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(middle) + lag,
                                               0,
                                               static_cast<std::ptrdiff_t>(station_m_.size()) - 1);
                best = {.shift_m = station_m_[static_cast<std::size_t>(other)] - station_m_[middle],
                        .correlation = correlation};
            }
        }
        return best;
    }

private:
    std::size_t index_of(double station_m) const {
        return static_cast<std::size_t>(std::ranges::lower_bound(station_m_, station_m) -
                                        station_m_.begin());
    }

    double at_lag(std::size_t from, std::size_t to, std::ptrdiff_t lag) const {
        double product = 0, own = 0, other = 0;
        for (std::size_t k = from; k < to; ++k) {
            const auto j = static_cast<std::ptrdiff_t>(k) + lag;
            if (j >= 0 && j < static_cast<std::ptrdiff_t>(modelled_.size())) {
                const double model = modelled_[static_cast<std::size_t>(j)];
                product += measured_[k] * model;
                own += measured_[k] * measured_[k];
                other += model * model;
            }
        }
        return own > 0 && other > 0 ? product / std::sqrt(own * other) : -1;
    }

    std::span<const double> station_m_;
    std::vector<double> measured_;
    std::vector<double> modelled_;
};

} // namespace

ShiftKnots knots_along(std::span<const double> station_m) {
    const double length_m = station_m.back() - station_m.front();
    return {.first_m = station_m.front(),
            .count = 2 + static_cast<std::size_t>(length_m / ShiftKnots::spacing_m)};
}

double share_of(const ShiftKnots& knots, std::size_t knot, double station_m) {
    const double at = (station_m - knots.first_m) / ShiftKnots::spacing_m;
    return std::max(0.0, 1 - std::abs(at - static_cast<double>(knot)));
}

std::vector<double> shifts_at(const ShiftKnots& knots,
                              std::span<const double> value_m,
                              std::span<const double> station_m) {
    std::vector<double> shift_m;
    shift_m.reserve(station_m.size());
    for (const double station : station_m) {
        const double at = (station - knots.first_m) / ShiftKnots::spacing_m;
        const auto i = std::min(static_cast<std::size_t>(at), knots.count - 2);
        shift_m.push_back(std::lerp(value_m[i], value_m[i + 1], at - static_cast<double>(i)));
    }
    return shift_m;
}

std::vector<double> correlated_shifts(const ShiftKnots& knots,
                                      std::span<const double> station_m,
                                      std::span<const double> measured,
                                      std::span<const double> modelled,
                                      double step_s) {
    const Correlator correlator{station_m, banded(measured, step_s), banded(modelled, step_s)};
    const auto knot_m = [&](std::size_t knot) {
        return knots.first_m + ShiftKnots::spacing_m * static_cast<double>(knot);
    };
    Match first;
    std::size_t start = 0;
    for (std::size_t knot = 0; knot < knots.count; ++knot) {
        const auto match = correlator.best(knot_m(knot), 0, search_m);
        if (match.correlation > first.correlation) {
            first = match;
            start = knot;
        }
    }
    std::vector<double> shift_m(knots.count, first.shift_m);
    const auto follow = [&](std::size_t knot, std::size_t beside) {
        const auto match = correlator.best(knot_m(knot), shift_m[beside], max_change_m);
        shift_m[knot] = match.correlation > 0 ? match.shift_m : shift_m[beside];
    };
    for (std::size_t knot = start + 1; knot < knots.count; ++knot) {
        follow(knot, knot - 1);
    }
    for (std::size_t knot = start; knot-- > 0;) {
        follow(knot, knot + 1);
    }
    return shift_m;
}

} // namespace macadam
