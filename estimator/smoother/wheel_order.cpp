#include "estimator/smoother/wheel_order.hpp"

#include "estimator/common/statistics.hpp"
#include "estimator/smoother/adaptation/road_prior_scale.hpp"

#include <cmath>
#include <complex>
#include <numbers>

namespace macadam {
namespace {

using Complex = std::complex<double>;

constexpr double min_turn_m = 1.6; // radius 0.25 m, a small car's
constexpr double max_turn_m = 2.5; // radius 0.40 m, a van's
constexpr double piece_m = 200;    // wheels with 0.3 % radius difference drift by a third of a turn
constexpr std::size_t min_pieces = 4;
constexpr std::size_t max_pieces = 24; // sufficient; the rest of a long trip is ignored
constexpr double memory_m = 60;        // of the line's amplitude and phase, to either side
constexpr int neighbours = 12;         // on each side, as a reference for the road's spectrum

/// Returns the Fourier component of a channel at a frequency in distance, between two samples.
Complex line_at(const DriveRecord& drive,
                const std::vector<double>& felt,
                std::size_t from,
                std::size_t to,
                double turns_per_m) {
    Complex sum = 0;
    for (std::size_t k = from + 1; k < to; ++k) {
        const double run_m = drive.travel_m[k] - drive.travel_m[k - 1];
        sum += felt[k] * run_m *
               std::polar(1.0, -2 * std::numbers::pi * turns_per_m * drive.travel_m[k]);
    }
    return sum;
}

/// Returns the samples at which pieces of piece_m begin and end.
std::vector<std::pair<std::size_t, std::size_t>> pieces_of(const DriveRecord& drive) {
    std::vector<std::pair<std::size_t, std::size_t>> pieces;
    std::size_t from = 0;
    for (std::size_t k = 1; k < drive.travel_m.size(); ++k) {
        if (drive.travel_m[k] - drive.travel_m[from] >= piece_m) {
            pieces.emplace_back(from, k);
            from = k;
        }
    }
    if (pieces.size() > max_pieces) { // evenly spread
        std::vector<std::pair<std::size_t, std::size_t>> some;
        for (std::size_t i = 0; i < max_pieces; ++i) {
            some.push_back(pieces[i * pieces.size() / max_pieces]);
        }
        return some;
    }
    return pieces;
}

/// Returns the power of all channels at `count` frequencies from lowest * step, relative to the
/// usual. All pieces have equal weight, however rough.
std::vector<double> power_at(const DriveRecord& drive,
                             const std::vector<std::pair<std::size_t, std::size_t>>& pieces,
                             std::size_t lowest,
                             std::size_t count,
                             double step) {
    std::vector<double> power(count);
    for (const auto& felt : drive.felt) {
        if (felt.empty()) {
            continue;
        }
        for (const auto& [from, to] : pieces) {
            std::vector<double> own(count);
            for (std::size_t i = 0; i < count; ++i) {
                own[i] = std::norm(
                    line_at(drive, felt, from, to, static_cast<double>(lowest + i) * step));
            }
            const double usual = median(own);
            for (std::size_t i = 0; i < count; ++i) {
                power[i] += usual > 0 ? own[i] / usual : 0;
            }
        }
    }
    return power;
}

/// Extracts the slowly changing part of `felt` at the frequency: amplitude and phase over memory_m
/// to either side.
std::vector<double>
line_of(const DriveRecord& drive, const std::vector<double>& felt, double turns_per_m) {
    const std::size_t n = felt.size();
    std::vector<Complex> turned(n);
    std::vector<double> run_m(n);
    for (std::size_t k = 0; k < n; ++k) {
        run_m[k] = k == 0 ? 0 : drive.travel_m[k] - drive.travel_m[k - 1];
        turned[k] = std::polar(1.0, -2 * std::numbers::pi * turns_per_m * drive.travel_m[k]);
    }
    std::vector<Complex> sum(n);
    std::vector<double> weight(n);
    Complex running = 0;
    double running_m = 0;
    for (std::size_t k = 0; k < n; ++k) { // behind, and here
        const double keep = std::exp(-run_m[k] / memory_m);
        running = keep * running + felt[k] * run_m[k] * turned[k];
        running_m = keep * running_m + run_m[k];
        sum[k] = running;
        weight[k] = running_m;
    }
    running = 0;
    running_m = 0;
    for (std::size_t k = n - 1; k-- > 0;) { // ahead
        const double keep = std::exp(-run_m[k + 1] / memory_m);
        running = keep * (running + felt[k + 1] * run_m[k + 1] * turned[k + 1]);
        running_m = keep * (running_m + run_m[k + 1]);
        sum[k] += running;
        weight[k] += running_m;
    }
    std::vector<double> line(n);
    for (std::size_t k = 0; k < n; ++k) {
        line[k] = weight[k] > 0 ? 2 * (sum[k] * std::conj(turned[k])).real() / weight[k] : 0;
    }
    return line;
}

/// Returns the significance threshold of a line. On a road without a line, power averaged over this
/// many pieces is that of its neighbours times a gamma variate, of which this is a quantile; the
/// maximum of some hundred frequencies exceeds it once in a thousand. (E. B. Wilson, M. M.
/// Hilferty, "The distribution of chi-square", PNAS 17 (1931), pp. 684-688.)
double surely_a_line(double looks) {
    constexpr double deviations = 5; // 4.3 for one in 100,000, plus scatter of the neighbours
    return std::pow(1 - 1 / (9 * looks) + deviations / (3 * std::sqrt(looks)), 3);
}

} // namespace

std::optional<double> wheel_circumference_m(const DriveRecord& drive) {
    const auto pieces = pieces_of(drive);
    if (pieces.size() < min_pieces) {
        return std::nullopt;
    }
    const double step = 0.5 / piece_m; // two per resolution cell
    const auto first = static_cast<std::size_t>(1 / max_turn_m / step);
    const auto last = static_cast<std::size_t>(1 / min_turn_m / step);
    const std::size_t lowest = first - neighbours;
    const auto power = power_at(drive, pieces, lowest, last + neighbours + 1 - lowest, step);
    double best = 0;
    std::size_t at = 0;
    for (std::size_t i = neighbours; i + neighbours < power.size(); ++i) {
        std::vector<double> around;
        for (std::size_t k = 3; k <= neighbours; ++k) {
            around.push_back(power[i - k]);
            around.push_back(power[i + k]);
        }
        const double ratio = power[i] / median(std::move(around));
        if (ratio > best) {
            best = ratio;
            at = i;
        }
    }
    // Channels that observe the same side of the road are correlated.
    const auto [mean, half] = felt_by({&drive, 1});
    const double sides = (mean ? 1 : 0) + (half ? 1 : 0);
    if (!(best > surely_a_line(static_cast<double>(pieces.size()) * sides))) {
        return std::nullopt;
    }
    return 1 / (static_cast<double>(lowest + at) * step);
}

DriveRecord without_wheel_order(DriveRecord drive, double turn_m) {
    for (auto& felt : drive.felt) {
        for (int harmonic = 1; harmonic <= 2 && !felt.empty(); ++harmonic) {
            const auto line = line_of(drive, felt, harmonic / turn_m);
            for (std::size_t k = 0; k < felt.size(); ++k) {
                felt[k] -= line[k];
            }
        }
    }
    return drive;
}

} // namespace macadam
