#include "estimator/identification/likelihood/whitening.hpp"

#include <gtest/gtest.h>

#include <random>

namespace macadam::testing {
namespace {

constexpr double step_s = 0.02;
constexpr FrequencyBand band{.from_hz = 0.5, .to_hz = 20};

/// Noise of two channels: the first changes slowly, the second contains half of the first.
Eigen::MatrixXd coloured_noise(unsigned seed) {
    std::mt19937 random{seed};
    std::normal_distribution<double> normal;
    Eigen::MatrixXd noise(4096, 2);
    double slow = 0;
    for (Eigen::Index k = 0; k < noise.rows(); ++k) {
        slow = 0.9 * slow + normal(random);
        noise.row(k) << 3 * slow, 1.5 * slow + 0.1 * normal(random);
    }
    return noise;
}

TEST(Whitening, GivesColouredAndCorrelatedNoiseUnitVariancePerDegreeOfFreedom) {
    const Whitening whitening{coloured_noise(1), step_s, band};
    const Eigen::MatrixXd white = whitening(coloured_noise(2));
    const double degrees = 2 * (band.to_hz - band.from_hz) * step_s * 4096; // of a channel
    for (const Eigen::Index channel : {0, 1}) {
        EXPECT_NEAR(white.col(channel).squaredNorm() / degrees, 1, 0.1);
    }
    EXPECT_NEAR(white.col(0).dot(white.col(1)) / degrees, 0, 0.06);
    // Neighbouring samples of a band-limited signal: sinc of 0.8.
    const double lagged = white.col(0).head(4095).dot(white.col(0).tail(4095));
    EXPECT_NEAR(lagged / white.col(0).squaredNorm(), 0.2, 0.1);
}

/// Residuals of a few seconds give a spectral matrix of few frequencies, whose inverse would be too
/// large without its correction: by a third here.
TEST(Whitening, IsUnbiasedByShortResiduals) {
    std::mt19937 random{3};
    std::normal_distribution<double> normal;
    const auto noise = [&] {
        return Eigen::MatrixXd::NullaryExpr(512, 3, [&] { return normal(random); }).eval();
    };
    const double degrees = 3 * 2 * (band.to_hz - band.from_hz) * step_s * 512;
    double mean = 0;
    constexpr int times = 50;
    for (int i = 0; i < times; ++i) {
        const Whitening whitening{noise(), step_s, band};
        mean += whitening(noise()).squaredNorm() / degrees / times;
    }
    EXPECT_NEAR(mean, 1, 0.05);
}

} // namespace
} // namespace macadam::testing
