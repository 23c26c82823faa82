#pragma once

#include "estimator/identification/amplitude_spectrum.hpp"
#include "estimator/identification/profile_response.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

struct SpectrumFitConfig {
    Band band{.from_hz = 0.5, .to_hz = 15, .smoothing_hz = 0.5}; ///< paper section VI-A, figure 6
    double run_in_s = 3; ///< start-up of the modelled car; e^-7 of body bounce remains
};

/// Spectra of one channel in m/s2 / sqrt(Hz): the measurement, and gain times the model's response.
struct ChannelSpectra {
    AmplitudeSpectrum measured;
    std::vector<double> before; ///< with the initial parameters, same size as measured
    std::vector<double> after;  ///< with the fitted parameters
    double misfit_before;       ///< root mean square of the difference over that of measured
    double misfit_after;
};

/// Result of fitting the modelled spectra to the measured ones.
struct SpectrumFit {
    HalfCar start;
    HalfCar found;
    double gain; ///< measured = gain * modelled (the paper's mu); 1 at the start
    ChannelSpectra vertical;
    std::optional<ChannelSpectra> lateral;     ///< `std::nullopt`: is_kgm2 is the known car's
    std::map<std::string, double> relative_sd; ///< of the fitted parameters, by field name
};

/// Identifies a car by the method of the paper: fits the body accelerations of a one-axle model to
/// those measured on a known road. Only amplitude spectra are compared, so an error of metres in
/// the position does no harm.
///
/// Vertical acceleration determines ks, cs, kt and the gain; lateral acceleration (where it was
/// measured, with both tracks) determines is_kgm2 given these. The fit starts at the golden car's
/// springs, damper and tyre, is_kgm2 3000 (times the height, where that is known) and gain 1.
///
/// \param known  supplies the masses and the width.
/// \param height_above_roll_axis_m  0: not known, and folded into is_kgm2.
/// \throws InputError  if the ride has no vertical acceleration or is shorter than 10 s beyond the
///                     run-in.
///
/// The standard deviations are those of the fit; they exclude the error of modelling one axle only.
///
/// Source: the paper, sections V and VI-A, table III.
SpectrumFit fit_spectra(const ProfileResponse& ride,
                        const HalfCar& known,
                        double height_above_roll_axis_m,
                        const SpectrumFitConfig& config);

/// Returns the vehicle with the fitted parameters and their uncertainty. The fitted gain is that of
/// one axle: for a vehicle with two, it becomes `one_axle_gain`.
Vehicle identified(Vehicle vehicle, const SpectrumFit& fit);

} // namespace macadam
