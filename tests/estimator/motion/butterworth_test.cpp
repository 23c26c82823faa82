#include "estimator/motion/butterworth.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace macadam::testing {
namespace {

using std::numbers::pi;

std::vector<double> sine(double frequency_hz, double rate_hz, std::size_t count) {
    std::vector<double> signal(count);
    for (std::size_t i = 0; i < count; ++i) {
        signal[i] = std::sin(2 * pi * frequency_hz * static_cast<double>(i) / rate_hz);
    }
    return signal;
}

/// Amplitude of the sine that came out, by projection over whole periods in the middle.
double gain(const std::vector<Section>& sections, double frequency_hz, double rate_hz) {
    const auto in = sine(frequency_hz, rate_hz, 8000);
    const auto out = zero_phase(sections, in, 2000);
    double sum = 0;
    for (std::size_t i = 2000; i < 6000; ++i) {
        sum += 2 * in[i] * out[i] / 4000;
    }
    return sum;
}

/// |H|^2 of the bilinear Butterworth in closed form, once each way; no phase is left.
TEST(Filter, LowPassHasTheSquaredButterworthGain) {
    const auto sections = butterworth_lowpass(4, 13, 100);
    for (const double f : {1.0, 5.0, 10.0, 13.0, 16.0, 20.0}) {
        const double ratio = std::tan(pi * f / 100) / std::tan(pi * 13.0 / 100);
        EXPECT_NEAR(gain(sections, f, 100), 1 / (1 + std::pow(ratio, 8)), 1e-6) << f;
    }
}

TEST(Filter, HighPassHasTheSquaredButterworthGain) {
    const auto sections = butterworth_highpass(2, 0.5, 100);
    for (const double f : {0.25, 0.5, 1.0, 2.0, 10.0}) {
        const double ratio = std::tan(pi * 0.5 / 100) / std::tan(pi * f / 100);
        EXPECT_NEAR(gain(sections, f, 100), 1 / (1 + std::pow(ratio, 4)), 1e-4) << f;
    }
}

TEST(Filter, KeepsAStraightLineUpToItsEnds) {
    std::vector<double> line(400);
    for (std::size_t i = 0; i < line.size(); ++i) {
        line[i] = 9.81 + 0.01 * static_cast<double>(i);
    }
    const auto out = zero_phase(butterworth_lowpass(4, 13, 100), line, 100);
    ASSERT_EQ(out.size(), line.size());
    for (std::size_t i = 0; i < line.size(); ++i) {
        EXPECT_NEAR(out[i], line[i], 1e-9) << i;
    }
}

TEST(Filter, TakesSignalsShorterThanItsSettling) {
    EXPECT_TRUE(zero_phase(butterworth_lowpass(4, 13, 100), {}, 50).empty());
    EXPECT_NEAR(zero_phase(butterworth_lowpass(4, 13, 100), std::vector{3.0}, 50)[0], 3, 1e-12);
    EXPECT_EQ(zero_phase(butterworth_highpass(2, 0.5, 100), std::vector(5, 2.0), 600).size(), 5);
}

} // namespace
} // namespace macadam::testing
