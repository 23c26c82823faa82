#pragma once

#include "estimator/smoother/vibration/resonance.hpp"
#include "estimator/smoother/vibration/vibration_spectra.hpp"
#include "estimator/vehicle/vehicle.hpp"

#include <Eigen/Core>

namespace macadam {

/// Comparison of a trip's spectra with those of modelled cars over a road of which only the
/// smoothness of its spectrum is known: one level for each speed and channel, and levels of the
/// octaves of wavelength, common to all speeds, fitted to the logarithms.
class VibrationFit {
public:
    /// \param imu  with the sensor's noise
    /// \param with_pitch  uses pitch rate too; the cars must have axles
    VibrationFit(const VibrationSpectra& spectra, const ImuMount& imu, bool with_pitch);

    bool empty() const { return rows_.empty(); } ///< too little was driven
    double slowest_mps() const;
    double fastest_mps() const;

    /// Returns the logarithm of a car's power in each row, on any level.
    Eigen::VectorXd modelled(const Vehicle& car) const;

    /// Returns twice the negative logarithm of the likelihood, tempered because no car is linear,
    /// over the speeds above `from_mps` and up to `to_mps`. The difference between cars counts.
    double misfit(const Eigen::VectorXd& modelled,
                  const Resonance& mount,
                  double from_mps = 0,
                  double to_mps = 1e9) const;

private:
    struct Row {
        double speed_mps;
        std::size_t channel, bin;
        double log_power;
        double root_weight;
    };

    std::vector<Row> rows_;
    Eigen::MatrixXd fitted_; ///< orthonormal: levels and octaves, weighted
};

} // namespace macadam
