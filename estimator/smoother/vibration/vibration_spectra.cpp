#include "estimator/smoother/vibration/vibration_spectra.hpp"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <span>

namespace macadam {
namespace {

constexpr double window_s = 5.12;
constexpr double max_speed_ratio = 1.25; // within a window
constexpr double class_ratio = 1.12;     // of the speeds of neighbouring classes
constexpr double usable_share = 0.45;    // of the rate, below the log's own anti-aliasing
constexpr double white_share = 0.4;      // of the rate, below that of make_stretch()

// Bands of a window, in bins: around wheel hop (7 to 13 Hz), and the last ones used.
constexpr std::size_t first_low_bin = 10;
constexpr std::size_t low_bins = 15;
constexpr std::size_t high_bins = 10;
constexpr double looks_per_bin = 1.4; // Hann window of 5 s

using Power = VibrationSpectra::Power;

/// Returns the power spectral density in the bins, per hertz. Hann window; the mean is removed.
Power power_of(std::span<const float> values, double step_s) {
    const std::size_t n = values.size();
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(n);
    std::vector<double> signal(n);
    double weight = 0;
    for (std::size_t k = 0; k < n; ++k) {
        const double turn = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
        const double hann = (1 - std::cos(turn)) / 2;
        signal[k] = hann * (static_cast<double>(values[k]) - mean);
        weight += hann * hann;
    }
    Eigen::FFT<double> fourier;
    fourier.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    std::vector<std::complex<double>> waves;
    fourier.fwd(waves, signal);
    Power power{};
    std::array<double, VibrationSpectra::bins> count{};
    for (std::size_t i = 0; i < waves.size(); ++i) {
        const double hz = static_cast<double>(i) / (step_s * static_cast<double>(n));
        const double at = std::round((hz - VibrationSpectra::first_hz) / VibrationSpectra::step_hz);
        if (at >= 0 && at < static_cast<double>(VibrationSpectra::bins)) {
            const auto bin = static_cast<std::size_t>(at);
            power[bin] += 2 * step_s * std::norm(waves[i]) / weight;
            count[bin] += 1;
        }
    }
    for (std::size_t bin = 0; bin < power.size(); ++bin) {
        power[bin] /= std::max(count[bin], 1.0);
    }
    return power;
}

/// Geometric mean over the first `bins`; 0 if a bin is empty.
double level_of(const Power& power, std::size_t bins) {
    double sum = 0;
    for (std::size_t bin = 0; bin < bins; ++bin) {
        sum += std::log(power[bin]);
    }
    return std::exp(sum / static_cast<double>(bins));
}

/// Mean over the bins [from, to).
double mean_of(const Power& power, std::size_t from, std::size_t to) {
    return std::accumulate(power.begin() + static_cast<std::ptrdiff_t>(from),
                           power.begin() + static_cast<std::ptrdiff_t>(to),
                           0.0) /
           static_cast<double>(to - from);
}

std::size_t bins_below(double hz) {
    const double last = (hz - VibrationSpectra::first_hz) / VibrationSpectra::step_hz;
    return static_cast<std::size_t>(
        std::clamp(last, 0.0, static_cast<double>(VibrationSpectra::bins)));
}

} // namespace

void add(VibrationSpectra& spectra, const Stretch& stretch) {
    const auto n = static_cast<std::size_t>(std::lround(window_s / stretch.step_s)) / 2 * 2;
    if (stretch.vertical_mps2.size() < n) {
        return;
    }
    const std::size_t bins = bins_below(usable_share / stretch.step_s);
    const std::size_t white_bins = bins_below(white_share / stretch.step_s);
    spectra.used_bins = std::min(spectra.used_bins, bins);
    spectra.pitch_noise_radps = std::max(spectra.pitch_noise_radps, stretch.pitch_noise_radps);
    const double white_power = 2 * stretch.step_s; // a hertz, of readings of variance 1
    spectra.has_pitch = spectra.has_pitch && !stretch.pitch_radps.empty();
    const std::span<const float> felt[] = {stretch.vertical_mps2, stretch.pitch_radps};
    for (std::size_t from = 0; from + n <= stretch.vertical_mps2.size(); from += n / 2) {
        const auto speed = std::span{stretch.speed_mps}.subspan(from, n);
        const auto [slowest, fastest] = std::ranges::minmax(speed);
        if (slowest <= 0 || fastest > max_speed_ratio * static_cast<double>(slowest)) {
            continue;
        }
        const double mean_mps =
            std::accumulate(speed.begin(), speed.end(), 0.0) / static_cast<double>(n);
        auto& at =
            spectra
                .speeds[static_cast<int>(std::lround(std::log(mean_mps) / std::log(class_ratio)))];
        for (std::size_t channel = 0; channel < VibrationSpectra::channels; ++channel) {
            if (felt[channel].empty()) {
                continue;
            }
            const auto power = power_of(felt[channel].subspan(from, n), stretch.step_s);
            const double level = level_of(power, spectra.used_bins);
            if (!(level > 0)) {
                continue; // a still sensor
            }
            for (std::size_t bin = 0; bin < power.size(); ++bin) {
                at.power[channel][bin] += power[bin] / level;
            }
            at.noise[channel] += white_power / level;
            if (channel == 0 && white_bins >= first_low_bin + low_bins + high_bins) {
                const std::size_t first_high_bin = white_bins - high_bins;
                spectra.windows.push_back(
                    {std::log(mean_mps),
                     mean_of(power, first_low_bin, first_low_bin + low_bins) / white_power,
                     mean_of(power, first_high_bin, white_bins) / white_power,
                     looks_per_bin * high_bins});
            }
        }
        ++at.windows;
        at.log_speed += std::log(mean_mps);
    }
}

double inverse_strength(const VibrationSpectra& spectra) {
    double sum = 0;
    for (const auto& window : spectra.windows) {
        sum += 1 / std::sqrt(window.low);
    }
    return sum / static_cast<double>(spectra.windows.size());
}

} // namespace macadam
