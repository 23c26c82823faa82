#include "estimator/motion/butterworth.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace macadam {
namespace {

/// Builds a section from 1 / (s^2 + s / q + 1) by s -> (1 - z^-1) / (1 + z^-1) / corner.
template <typename Numerator>
std::vector<Section> butterworth(int order, double corner_hz, double rate_hz, Numerator numerator) {
    assert(order > 0 && order % 2 == 0 && corner_hz > 0 && 2 * corner_hz < rate_hz);
    const double w = std::tan(std::numbers::pi * corner_hz / rate_hz);
    std::vector<Section> sections;
    for (int pair = 0; pair < order / 2; ++pair) {
        const double angle = std::numbers::pi * (2 * pair + 1) / (2 * order);
        const double damping = 2 * std::sin(angle) * w;
        const double norm = 1 + damping + w * w;
        const auto [b0, b1, b2] = numerator(w);
        sections.push_back({.b0 = b0 / norm,
                            .b1 = b1 / norm,
                            .b2 = b2 / norm,
                            .a1 = 2 * (w * w - 1) / norm,
                            .a2 = (1 - damping + w * w) / norm});
    }
    return sections;
}

struct Numerator {
    double b0, b1, b2;
};

/// Filters in place, from the steady state of the first value.
void run(const Section& section, std::vector<double>& signal) {
    const auto [b0, b1, b2, a1, a2] = section;
    const double steady = signal.front() * (b0 + b1 + b2) / (1 + a1 + a2);
    // Transposed direct form II.
    double first = steady - b0 * signal.front();
    double second = b2 * signal.front() - a2 * steady;
    for (double& value : signal) {
        const double in = value;
        value = b0 * in + first;
        first = b1 * in - a1 * value + second;
        second = b2 * in - a2 * value;
    }
}

/// Extends the signal by `count` samples on both sides, by point reflection at its ends.
std::vector<double> extended(std::span<const double> signal, std::size_t count) {
    std::vector<double> out;
    out.reserve(signal.size() + 2 * count);
    for (std::size_t i = count; i > 0; --i) {
        out.push_back(2 * signal.front() - signal[i]);
    }
    out.insert(out.end(), signal.begin(), signal.end());
    for (std::size_t i = 1; i <= count; ++i) {
        out.push_back(2 * signal.back() - signal[signal.size() - 1 - i]);
    }
    return out;
}

} // namespace

std::vector<Section> butterworth_lowpass(int order, double corner_hz, double rate_hz) {
    return butterworth(order, corner_hz, rate_hz, [](double w) {
        return Numerator{w * w, 2 * w * w, w * w};
    });
}

std::vector<Section> butterworth_highpass(int order, double corner_hz, double rate_hz) {
    return butterworth(order, corner_hz, rate_hz, [](double) { return Numerator{1, -2, 1}; });
}

std::vector<double>
zero_phase(std::span<const Section> sections, std::span<const double> signal, std::size_t settle) {
    if (signal.empty()) {
        return {};
    }
    const std::size_t margin = std::min(settle, signal.size() - 1);
    auto out = extended(signal, margin);
    for (int way = 0; way < 2; ++way) {
        for (const auto& section : sections) {
            run(section, out);
        }
        std::ranges::reverse(out);
    }
    out.erase(out.end() - static_cast<std::ptrdiff_t>(margin), out.end());
    out.erase(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(margin));
    return out;
}

} // namespace macadam
