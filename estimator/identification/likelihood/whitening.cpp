#include "estimator/identification/likelihood/whitening.hpp"

#include <Eigen/Cholesky>
#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <complex>

namespace macadam {
namespace {

using Complex = std::complex<double>;

constexpr double smoothing_hz = 0.5;     // to either side
constexpr std::size_t min_smoothing = 4; // frequencies to either side, for three channels
constexpr double ridge = 1e-9;           // of the trace, for channels without noise

/// Returns the Fourier transform of every column, for frequencies from 0 to half the rate.
std::vector<std::vector<Complex>> transforms_of(const Eigen::MatrixXd& signals) {
    Eigen::FFT<double> fourier;
    fourier.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    std::vector<std::vector<Complex>> transforms(static_cast<std::size_t>(signals.cols()));
    for (Eigen::Index channel = 0; channel < signals.cols(); ++channel) {
        const std::vector<double> column(signals.col(channel).begin(), signals.col(channel).end());
        fourier.fwd(transforms[static_cast<std::size_t>(channel)], column);
    }
    return transforms;
}

Eigen::VectorXcd at_frequency(const std::vector<std::vector<Complex>>& transforms, std::size_t i) {
    Eigen::VectorXcd values(static_cast<Eigen::Index>(transforms.size()));
    for (std::size_t channel = 0; channel < transforms.size(); ++channel) {
        values[static_cast<Eigen::Index>(channel)] = transforms[channel][i];
    }
    return values;
}

/// Returns the divisor of a sum of squares over frequencies that makes the inverse of the quotient
/// unbiased: the mean of an inverse Wishart matrix. It is count - channels - 1 for real values,
/// count - channels for complex ones.
///
/// Source: T. W. Anderson, "An Introduction to Multivariate Statistical Analysis", 3rd ed. 2003,
/// section 7.7.
double divisor_of(std::size_t count, Eigen::Index channels) {
    return std::max(1.0, static_cast<double>(count) - static_cast<double>(channels));
}

} // namespace

Whitening::Whitening(const Eigen::MatrixXd& residual, double step_s, FrequencyBand band) {
    const auto transforms = transforms_of(residual);
    const auto channels = residual.cols();
    const double step_hz = 1 / (step_s * static_cast<double>(residual.rows()));
    first_ = static_cast<std::size_t>(std::ceil(band.from_hz / step_hz));
    const auto last =
        std::min(static_cast<std::size_t>(band.to_hz / step_hz), transforms[0].size() - 2);
    const auto half = std::max(min_smoothing, static_cast<std::size_t>(smoothing_hz / step_hz));
    for (std::size_t i = first_; i <= last; ++i) {
        const auto from = std::max(first_, i - std::min(i, half));
        const auto to = std::min(last, i + half);
        Eigen::MatrixXcd density = Eigen::MatrixXcd::Zero(channels, channels);
        for (std::size_t j = from; j <= to; ++j) {
            const auto values = at_frequency(transforms, j);
            density += values * values.adjoint();
        }
        density /= divisor_of(to - from + 1, channels);
        density += ridge * density.trace() * Eigen::MatrixXcd::Identity(channels, channels);
        const Eigen::LLT<Eigen::MatrixXcd> root{density};
        inverse_root_.push_back(
            root.matrixL().solve(Eigen::MatrixXcd::Identity(channels, channels)));
    }
}

Eigen::MatrixXd Whitening::operator()(const Eigen::MatrixXd& signals) const {
    const auto transforms = transforms_of(signals);
    std::vector<std::vector<Complex>> white(transforms.size(),
                                            std::vector<Complex>(transforms[0].size()));
    // The inverse transform divides by the number of rows.
    const double unit = std::sqrt(static_cast<double>(signals.rows()));
    for (std::size_t i = 0; i < inverse_root_.size(); ++i) {
        const Eigen::VectorXcd values =
            unit * inverse_root_[i] * at_frequency(transforms, first_ + i);
        for (std::size_t channel = 0; channel < white.size(); ++channel) {
            white[channel][first_ + i] = values[static_cast<Eigen::Index>(channel)];
        }
    }
    Eigen::FFT<double> fourier;
    fourier.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    Eigen::MatrixXd out(signals.rows(), signals.cols());
    std::vector<double> column;
    for (std::size_t channel = 0; channel < white.size(); ++channel) {
        fourier.inv(column, white[channel], signals.rows());
        out.col(static_cast<Eigen::Index>(channel)) =
            Eigen::Map<const Eigen::VectorXd>{column.data(), signals.rows()};
    }
    return out;
}

} // namespace macadam
