#pragma once

#include <Eigen/Core>

#include <vector>

namespace macadam {

/// Frequencies that a likelihood uses.
struct FrequencyBand {
    double from_hz;
    double to_hz;
};

/// Whitens signals of several channels by the spectral matrix of their residuals, so that least
/// squares of the whitened signals is Whittle's likelihood.
///
/// Source: P. Whittle, "The analysis of multiple stationary time series", Journal of the Royal
/// Statistical Society B 15 (1953), pp. 125-139.
class Whitening {
public:
    /// Estimates the spectral matrix from residuals: the periodogram, averaged over 0.5 Hz to
    /// either side, and enlarged so that its inverse is unbiased.
    ///
    /// \param residual  a column per channel, at least two rows
    Whitening(const Eigen::MatrixXd& residual, double step_s, FrequencyBand band);

    /// Returns the signals with unit variance per degree of freedom, limited to the band: the sum
    /// of squares of `residual` becomes about twice the number of frequencies times channels.
    Eigen::MatrixXd operator()(const Eigen::MatrixXd& signals) const;

private:
    std::size_t first_; ///< index of the first frequency in the band
    std::vector<Eigen::MatrixXcd> inverse_root_;
};

} // namespace macadam
