#include "estimator/identification/amplitude_spectrum.hpp"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>

namespace macadam {
namespace {

/// Applies a Hann window of mean square 1 and pads with zeros to a power of two.
std::vector<double> windowed(std::span<const double> signal) {
    std::vector<double> out(std::bit_ceil(signal.size()));
    const auto count = static_cast<double>(signal.size());
    const double scale = std::sqrt(2.0 / 3); // of (1 - cos): its mean square is 3 / 2
    for (std::size_t i = 0; i < signal.size(); ++i) {
        const double angle = 2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / count;
        out[i] = scale * (1 - std::cos(angle)) * signal[i];
    }
    return out;
}

std::vector<double> magnitudes(const std::vector<double>& signal) {
    Eigen::FFT<double> fourier;
    fourier.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    std::vector<std::complex<double>> transform;
    fourier.fwd(transform, signal);
    std::vector<double> out(transform.size());
    std::ranges::transform(transform, out.begin(), [](const auto& z) { return std::abs(z); });
    return out;
}

} // namespace

AmplitudeSpectrum amplitude_spectrum(std::span<const double> signal, double step_s, Band band) {
    assert(signal.size() >= 2 && band.from_hz < band.to_hz && 2 * band.to_hz * step_s < 1);
    const auto padded = windowed(signal);
    const auto raw = magnitudes(padded);
    const double step_hz = 1 / (step_s * static_cast<double>(padded.size()));
    const double unit = std::sqrt(2 * step_s / static_cast<double>(signal.size()));

    std::vector<double> sums{0};
    for (const double value : raw) {
        sums.push_back(sums.back() + value);
    }
    const auto half = static_cast<std::size_t>(std::lround(band.smoothing_hz / 2 / step_hz));
    AmplitudeSpectrum spectrum;
    const auto first = static_cast<std::size_t>(std::ceil(band.from_hz / step_hz));
    for (std::size_t i = first; static_cast<double>(i) * step_hz <= band.to_hz; ++i) {
        const std::size_t low = i - std::min(i, half);
        const std::size_t high = std::min(raw.size(), i + half + 1);
        spectrum.hz.push_back(static_cast<double>(i) * step_hz);
        spectrum.amplitude.push_back(unit * (sums[high] - sums[low]) /
                                     static_cast<double>(high - low));
    }
    return spectrum;
}

} // namespace macadam
