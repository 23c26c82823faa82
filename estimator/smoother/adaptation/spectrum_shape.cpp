#include "estimator/smoother/adaptation/spectrum_shape.hpp"

#include "estimator/smoother/filter/road_process.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>

namespace macadam {
namespace {

constexpr std::size_t octaves = SpectrumShape::octaves;
constexpr auto matrix_octaves = static_cast<Eigen::Index>(octaves);
using Octaves = std::array<double, octaves>;
using Levels = Eigen::Matrix<double, matrix_octaves, 1>;

constexpr std::size_t order = max_road_lags - 1; // of the autoregression
constexpr double damping = 0.7;                  // of a round, in the logarithm

// Difference of the logarithms of neighbouring octaves, standard deviation. Slope spectra of
// measured roads differ from that of waviness 2 by factors of 0.24 to 7.8 over four octaves.
constexpr double neighbour_sd = 0.7;

constexpr double min_share = 0.02; // lower limit against the scatter of the draw
constexpr double min_power = 1e-6;
constexpr double min_weight = 1e-6; // of an octave without a mode

/// Returns the power at a frequency, interpolated between the middles of the octaves.
double power_at(const SpectrumShape& shape, double cycles_per_station, double cell_m) {
    const double wave_m = cell_m / cycles_per_station;
    const double octave = std::clamp(
        std::log2(wave_m / SpectrumShape::shortest_m) - 0.5, 0.0, static_cast<double>(octaves - 1));
    const auto below = std::min(static_cast<std::size_t>(octave), octaves - 2);
    return std::exp(std::lerp(
        shape.log_level[below], shape.log_level[below + 1], octave - static_cast<double>(below)));
}

/// Returns the power of an autoregression with increments of variance 1 in the middle of an octave.
double power_of(const std::vector<double>& weights, std::size_t octave, double cell_m) {
    const double middle_m =
        SpectrumShape::shortest_m * std::exp2(static_cast<double>(octave) + 0.5);
    const double turn = 2 * std::numbers::pi * cell_m / middle_m;
    std::complex<double> sum = 1;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum -= weights[i] * std::polar(1.0, -turn * static_cast<double>(i + 1));
    }
    return 1 / std::norm(sum);
}

/// Covariances of changes at 0 to `order` stations' distance, from their spectrum.
std::array<double, order + 1> covariances(const SpectrumShape& shape, double cell_m) {
    constexpr std::size_t lines = 600; // evenly spaced over the logarithm
    constexpr double lowest = 1e-3;    // cycles per station: waves of 250 m
    std::array<double, order + 1> covariance{};
    double before = 0;
    for (std::size_t i = 0; i <= lines; ++i) {
        const double cycles =
            lowest * std::pow(0.5 / lowest, static_cast<double>(i) / static_cast<double>(lines));
        const double power = 2 * power_at(shape, cycles, cell_m) * (cycles - before);
        for (std::size_t lag = 0; lag <= order; ++lag) {
            covariance[lag] +=
                power * std::cos(2 * std::numbers::pi * cycles * static_cast<double>(lag));
        }
        before = cycles;
    }
    return covariance;
}

/// Mean power of the modes of each octave, and their number.
struct OctavePower {
    Octaves power{};
    Octaves modes{};
};

OctavePower octave_power(const std::vector<double>& values, double cell_m) {
    const auto count = static_cast<double>(values.size());
    std::vector<double> padded(values);
    padded.resize(std::bit_ceil(values.size()));
    const auto size = static_cast<double>(padded.size());
    std::vector<std::complex<double>> spectrum;
    Eigen::FFT<double> fft;
    fft.fwd(spectrum, padded);
    OctavePower found;
    for (std::size_t i = 1; i < padded.size() / 2; ++i) {
        const double wave_m = cell_m * size / static_cast<double>(i);
        const double at = std::log2(wave_m / SpectrumShape::shortest_m);
        if (at >= 0 && at < static_cast<double>(octaves)) {
            const auto octave = static_cast<std::size_t>(at);
            found.power[octave] += std::norm(spectrum[i]) / count;
            found.modes[octave] += 1;
        }
    }
    for (std::size_t octave = 0; octave < octaves; ++octave) {
        found.power[octave] /= std::max(found.modes[octave], 1.0);
        found.modes[octave] *= count / size; // zeros appended add no information
    }
    return found;
}

/// Returns the most probable levels, given independent values of known weights and a random walk
/// from octave to octave.
Levels smoothed(const Levels& values, const Levels& weights) {
    constexpr double link = 1 / (neighbour_sd * neighbour_sd);
    Eigen::Matrix<double, matrix_octaves, matrix_octaves> precision = weights.asDiagonal();
    for (Eigen::Index i = 1; i < matrix_octaves; ++i) {
        precision(i, i) += link;
        precision(i - 1, i - 1) += link;
        precision(i, i - 1) -= link;
        precision(i - 1, i) -= link;
    }
    return precision.llt().solve(weights.cwiseProduct(values));
}

} // namespace

// Source: N. Levinson, "The Wiener RMS error criterion in filter design and prediction", Journal of
// Mathematics and Physics 25 (1946), pp. 261-278; J. Durbin, "The fitting of time-series models",
// Revue de l'Institut International de Statistique 28 (1960), pp. 233-244.
Autoregression autoregression_of(const SpectrumShape& shape, double cell_m) {
    const auto covariance = covariances(shape, cell_m);
    Autoregression process{.weights = {}, .increment_variance = covariance[0]};
    auto& weights = process.weights;
    for (std::size_t n = 1; n <= order; ++n) {
        double reflection = covariance[n];
        for (std::size_t i = 0; i + 1 < n; ++i) {
            reflection -= weights[i] * covariance[n - 1 - i];
        }
        reflection /= process.increment_variance;
        auto next = weights;
        next.push_back(reflection);
        for (std::size_t i = 0; i + 1 < n; ++i) {
            next[i] -= reflection * weights[n - 2 - i];
        }
        weights = std::move(next);
        process.increment_variance *= 1 - reflection * reflection;
    }
    return process;
}

SpectrumShape adapted(const SpectrumShape& shape,
                      const RoadPrior& prior,
                      const SmoothedRoad& road,
                      double cell_m) {
    std::vector<double> most_probable;
    std::vector<double> undetermined;
    for (std::size_t i = 1; i < prior.increments.size(); ++i) {
        const double sd = std::sqrt(prior.increments[i].mean);
        most_probable.push_back(road.increment_m[i].mean / sd);
        undetermined.push_back(road.perturbed_m[i].mean / sd);
    }
    const auto found = octave_power(most_probable, cell_m);
    const auto open = octave_power(undetermined, cell_m);
    Levels seen;
    Levels weight;
    Levels change; // of the increments' power from 1
    for (std::size_t octave = 0; octave < octaves; ++octave) {
        const auto at = static_cast<Eigen::Index>(octave);
        const double share = std::clamp(1 - open.power[octave], min_share, 1.0);
        change[at] = std::log(std::max(found.power[octave], min_power) / share);
        seen[at] = change[at] + std::log(power_of(prior.change_weights, octave, cell_m));
        weight[at] = found.modes[octave] * share * share / 2 + min_weight;
    }
    // The road's level follows the mean change (road_prior_scale.hpp); the shape, what differs.
    const double mean_change = weight.dot(change) / weight.sum();
    const Levels level = smoothed(seen, weight).array() - mean_change;
    const double before = std::log(autoregression_of(shape, cell_m).increment_variance);
    SpectrumShape next;
    for (std::size_t octave = 0; octave < octaves; ++octave) {
        next.log_level[octave] = std::lerp(
            shape.log_level[octave] - before, level[static_cast<Eigen::Index>(octave)], damping);
    }
    return next;
}

} // namespace macadam
