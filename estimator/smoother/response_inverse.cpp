#include "estimator/smoother/response_inverse.hpp"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>

namespace macadam {
namespace {

constexpr double max_raised = 3;
constexpr double beside_s = 2; // mirrored at both ends, to separate them

/// Frequency response of the analogue filter: poles on a circle.
std::complex<double> butterworth(double hz, double corner_hz, int order) {
    std::complex<double> below{1, 0};
    for (int k = 0; k < order; ++k) {
        const double angle = std::numbers::pi * (0.5 + (k + 0.5) / order);
        below *= std::complex<double>{0, hz / corner_hz} - std::polar(1.0, angle);
    }
    return 1.0 / below;
}

/// Mirrors the signal about its end values and pads it to a power of two.
std::vector<double> padded(const std::vector<double>& values, std::size_t beside) {
    std::vector<double> out;
    out.reserve(std::bit_ceil(values.size() + 2 * beside));
    for (std::size_t i = beside; i > 0; --i) {
        out.push_back(2 * values.front() - values[i]);
    }
    out.insert(out.end(), values.begin(), values.end());
    for (std::size_t i = 1; i <= beside; ++i) {
        out.push_back(2 * values.back() - values[values.size() - 1 - i]);
    }
    const double from = out.back();
    const double to = out.front();
    const std::size_t filled = out.size();
    const std::size_t whole = std::bit_ceil(filled + beside);
    for (std::size_t i = filled; i < whole; ++i) { // a line from the end to the beginning
        const double part =
            static_cast<double>(i - filled + 1) / static_cast<double>(whole - filled + 1);
        out.push_back(from + part * (to - from));
    }
    return out;
}

} // namespace

std::vector<double> without_response(const std::vector<double>& values,
                                     double step_s,
                                     const std::function<std::complex<double>(double)>& response) {
    if (values.size() < 3) {
        return values;
    }
    const std::size_t beside =
        std::min(values.size() - 1, static_cast<std::size_t>(std::lround(beside_s / step_s)));
    auto signal = padded(values, beside);
    const double step_hz = 1 / (step_s * static_cast<double>(signal.size()));
    Eigen::FFT<double> fourier;
    fourier.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    std::vector<std::complex<double>> waves;
    fourier.fwd(waves, signal);
    for (std::size_t i = 0; i < waves.size(); ++i) {
        const auto passed = response(static_cast<double>(i) * step_hz);
        waves[i] *= std::min(1.0, max_raised * std::abs(passed)) / passed;
    }
    // The component at half the rate must remain real, so its phase is not shifted.
    waves.back() = std::abs(waves.back()) * (waves.back().real() < 0 ? -1.0 : 1.0);
    fourier.inv(signal, waves, static_cast<Eigen::Index>(signal.size()));
    return {signal.begin() + static_cast<std::ptrdiff_t>(beside),
            signal.begin() + static_cast<std::ptrdiff_t>(beside + values.size())};
}

std::vector<double>
inverse_lowpass(const std::vector<double>& values, double step_s, double corner_hz, int order) {
    return without_response(
        values, step_s, [=](double hz) { return butterworth(hz, corner_hz, order); });
}

} // namespace macadam
