#pragma once

#include "estimator/identification/likelihood/profile_drive.hpp"
#include "estimator/identification/spectrum_fit.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace macadam {

struct LikelihoodFitConfig {
    double from_hz = 0.5; ///< below it, hills and bends dominate the readings
    double to_hz = 20;    ///< above it, bushes and the body's own modes; at most 0.45 of the rate
    double run_in_s = 3;  ///< start-up of the modelled car; e^-7 of body bounce remains
};

/// One parameter of the fitted car.
struct FittedParameter {
    std::string name; ///< of the vehicle file's field
    double start;     ///< the file's value, or the usual one
    double found;
    double prior_sd; ///< relative, as all below
    double sd;
    double sd_given_mass; ///< if the file's mass is right: readings depend only on ratios to it
    double drive_sd;      ///< sd without the share of what the model simplifies
};

/// Spectra of one channel, in m/s2 or rad/s over sqrt(Hz): the measurement, and the models of the
/// file's car and of the fitted one at the corrected stations. The misfits compare the readings
/// themselves, not their spectra.
struct ChannelFit {
    Channel channel;
    ChannelSpectra spectra;
};

/// Result of the likelihood fit.
struct LikelihoodFit {
    Vehicle vehicle; ///< fitted; its uncertainty is that given the mass
    std::vector<FittedParameter> parameters;
    Eigen::MatrixXd correlation; ///< of the parameters' logarithms
    std::vector<ChannelFit> channels;
    double from_m, to_m; ///< stations, before correction
    double duration_s;
    double min_shift_m, max_shift_m; ///< of the stations' correction

    /// The search ended because its last step would have moved no parameter of the car by more than
    /// a tenth of its standard deviation. Otherwise the values are not the maximum.
    bool settled;
};

/// Fits a car to its readings over a known road: the maximum of the posterior of its parameters,
/// under the uncertainties of its vehicle file and Whittle's likelihood of the readings. Residuals
/// have an unknown spectral matrix, estimated with the parameters. Corrections of the stations, the
/// dampers' asymmetry and the smoothing of the road by tyres and lane position are estimated as
/// well, so that their uncertainty is part of the others'.
///
/// Standard deviations are the larger of the information's and of the sandwich estimate, which
/// allows for uneven residuals (potholes, parts beside the track), and include 1.5 % (friction: 10
/// %) for what the model simplifies.
///
/// \param vehicle  with axles
/// \throws InputError  if the drive is shorter than 10 s beyond the run-in, or the modelled
/// readings
///                     are not finite.
///
/// Source: docs/method/identification.md; H. White, "Maximum likelihood estimation of misspecified
/// models", Econometrica 50 (1982), pp. 1-25.
LikelihoodFit fit_likelihood(const ProfileDrive& drive,
                             const Vehicle& vehicle,
                             const LikelihoodFitConfig& config);

/// Returns the parameters that the drive did not excite. Their standard deviation, without the
/// share of what the model simplifies, is above two thirds of the prior's: their value is the
/// file's.
std::vector<std::string> unexcited_parameters(const LikelihoodFit& fit);

} // namespace macadam
