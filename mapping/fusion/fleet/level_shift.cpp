#include "mapping/fusion/fleet/level_shift.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace macadam {
namespace {

constexpr double max_autocorrelation = 0.9; // beyond it, no length of series is enough

double square(double x) {
    return x * x;
}

/// Continued fraction of the incomplete beta function, by Lentz's method (W. H. Press et al.,
/// "Numerical Recipes", 3rd edition, Cambridge University Press 2007, section 6.4).
double beta_fraction(double a, double b, double x) {
    constexpr int max_terms = 500;
    constexpr double tiny = 1e-300;
    constexpr double precise = 1e-14;
    const auto not_zero = [](double value) { return std::abs(value) < tiny ? tiny : value; };
    double c = 1;
    double d = 1 / not_zero(1 - (a + b) * x / (a + 1));
    double fraction = d;
    for (int m = 1; m <= max_terms; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1 / not_zero(1 + even * d);
        c = not_zero(1 + even / c);
        fraction *= d * c;
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 / not_zero(1 + odd * d);
        c = not_zero(1 + odd / c);
        fraction *= d * c;
        if (std::abs(d * c - 1) < precise) {
            break;
        }
    }
    return fraction;
}

/// Regularised incomplete beta function I_x(a, b).
double incomplete_beta(double a, double b, double x) {
    if (x <= 0 || x >= 1) {
        return x <= 0 ? 0 : 1;
    }
    const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                  a * std::log(x) + b * std::log1p(-x));
    return x < (a + 1) / (a + b + 2) ? front * beta_fraction(a, b, x) / a
                                     : 1 - front * beta_fraction(b, a, 1 - x) / b;
}

/// Sums of weights 1 / variance, and of weighted values and squares, of the first values of a
/// series.
struct Sums {
    double weight = 0, value = 0, square_value = 0;

    friend Sums operator-(const Sums& a, const Sums& b) {
        return {a.weight - b.weight, a.value - b.value, a.square_value - b.square_value};
    }
    double mean() const { return value / weight; }
};

/// Returns the sums over the first 0, 1, ... values, relative to the first value: otherwise sums of
/// squares would lose digits.
std::vector<Sums> sums_of(std::span<const SeriesPoint> series) {
    std::vector<Sums> sums(1);
    for (const auto& [value, variance] : series) {
        const double off = value - series.front().value;
        const auto& last = sums.back();
        sums.push_back({last.weight + 1 / variance,
                        last.value + off / variance,
                        last.square_value + square(off) / variance});
    }
    return sums;
}

/// An interval of a series against the values outside. Up to the last value: a split.
struct Contrast {
    std::size_t first = 0, past = 0;
    double inside = 0, outside = 0; ///< means, relative to the first value of the series
    double sd = 0;                  ///< of their difference
    double t = 0;
};

Contrast contrast_of(const std::vector<Sums>& sums, std::size_t first, std::size_t past) {
    const auto& all = sums.back();
    const auto inside = sums[past] - sums[first];
    const auto outside = all - inside;
    const double rest =
        all.square_value - inside.value * inside.mean() - outside.value * outside.mean();
    const auto free = static_cast<double>(sums.size() - 3);
    const double sd =
        std::sqrt(std::max(0.0, rest) / free * (1 / inside.weight + 1 / outside.weight));
    const double t = sd > 0 ? (inside.mean() - outside.mean()) / sd : 0;
    return {first, past, inside.mean(), outside.mean(), sd, t};
}

/// Largest of several contrasts, and how many there are.
struct Search {
    Contrast best{};
    double count = 0;

    void add(const Contrast& contrast) {
        ++count;
        best = std::abs(contrast.t) > std::abs(best.t) ? contrast : best;
    }
};

Search best_split(const std::vector<Sums>& sums) {
    const auto size = sums.size() - 1;
    Search search;
    for (auto first = min_beside_shift; first + min_beside_shift <= size; ++first) {
        search.add(contrast_of(sums, first, size));
    }
    return search;
}

/// Searches intervals in steps that bound their number in long series.
Search best_interval(const std::vector<Sums>& sums) {
    constexpr std::size_t max_ends = 200;
    const auto size = sums.size() - 1;
    const auto step = 1 + size / max_ends;
    Search search;
    for (auto first = min_beside_shift; first + 2 * min_beside_shift <= size; first += step) {
        for (auto past = first + min_beside_shift; past + min_beside_shift <= size; past += step) {
            search.add(contrast_of(sums, first, past));
        }
    }
    return search;
}

/// Returns the correlation of neighbours about the means of a contrast, within 0 and its maximum.
double autocorrelation(std::span<const SeriesPoint> series, const Contrast& contrast) {
    double before = 0, squares = 0, products = 0;
    for (std::size_t i = 0; i < series.size(); ++i) {
        const bool is_inside = contrast.first <= i && i < contrast.past;
        const double mean = series.front().value + (is_inside ? contrast.inside : contrast.outside);
        const double off = (series[i].value - mean) / std::sqrt(series[i].variance);
        squares += square(off);
        products += off * before;
        before = off;
    }
    return squares > 0 ? std::clamp(products / squares, 0.0, max_autocorrelation) : 0;
}

/// Returns the shift of the best contrast of a search, with its p-value within that search.
LevelShift shift_of(std::span<const SeriesPoint> series, const Search& search) {
    const auto& best = search.best;
    const double alike = autocorrelation(series, best);
    const double wider = std::sqrt((1 + alike) / (1 - alike));
    const auto free = static_cast<double>(series.size() - 2);
    return {.first = best.first,
            .size = best.inside - best.outside,
            .sd = best.sd * wider,
            .p_value = std::min(1.0, search.count * student_t_tail(best.t / wider, free))};
}

} // namespace

double student_t_tail(double t, double degrees_of_freedom) {
    return incomplete_beta(
        degrees_of_freedom / 2, 0.5, degrees_of_freedom / (degrees_of_freedom + square(t)));
}

std::optional<LevelShift> find_level_shift(std::span<const SeriesPoint> series) {
    if (series.size() < 2 * min_beside_shift) {
        return std::nullopt;
    }
    const auto sums = sums_of(series);
    std::optional<LevelShift> likeliest;
    for (const auto& search : {best_split(sums), best_interval(sums)}) {
        if (search.best.t != 0) {
            const auto shift = shift_of(series, search);
            likeliest = likeliest && likeliest->p_value <= shift.p_value ? likeliest : shift;
        }
    }
    if (likeliest) {
        constexpr double searches = 2;
        likeliest->p_value = std::min(1.0, searches * likeliest->p_value);
    }
    return likeliest;
}

} // namespace macadam
