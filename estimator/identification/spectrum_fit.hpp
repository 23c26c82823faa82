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
    double run_in_s = 3; ///< the modelled car comes to its ride: e^-7 of body bounce is left
};

/// One channel, in m/s2 / sqrt(Hz): what was measured, and gain times what the model feels.
struct ChannelSpectra {
    AmplitudeSpectrum measured;
    std::vector<double> before; ///< by the parameters at the start, as many as measured
    std::vector<double> after;  ///< by those found
    double misfit_before;       ///< root mean square of the difference over that of measured
    double misfit_after;
};

/// The car that makes the modelled spectra most like the measured ones.
struct SpectrumFit {
    HalfCar start;
    HalfCar found;
    double gain; ///< measured = gain * modelled (the paper's mu); 1 at the start
    ChannelSpectra vertical;
    std::optional<ChannelSpectra> lateral;     ///< nothing: is_kgm2 is the known car's
    std::map<std::string, double> relative_sd; ///< of what was found, by the names of the fields
};

/// The paper's system identification: body accelerations of a car on a measured road against those
/// of a one-axle model over the same road, by amplitude spectra alone, so that an error of metres
/// in the place does no harm.
///
/// Vertical acceleration finds ks, cs, kt and the gain, lateral acceleration (where it was
/// measured, and both tracks) is_kgm2 with these. Started at the golden car's springs, damper and
/// tyre, is_kgm2 3000 (times the height, where that is known) and gain 1.
///
/// \param known  of it are the masses and the width.
/// \param height_above_roll_axis_m  0: not known, and folded into is_kgm2.
/// \throws InputError  if the ride has no vertical acceleration or is shorter than 10 s beyond the
///                     run-in.
///
/// The standard deviations are those of the fit: what a model of one axle gets wrong is not in
/// them.
///
/// Source: the paper, sections V and VI-A, table III.
SpectrumFit fit_spectra(const ProfileResponse& ride,
                        const HalfCar& known,
                        double height_above_roll_axis_m,
                        const SpectrumFitConfig& config);

/// A vehicle as a fit leaves it: the found numbers with their uncertainty in place of its own. The
/// gain is that of one axle: where the vehicle has two, `one_axle_gain`.
Vehicle identified(Vehicle vehicle, const SpectrumFit& fit);

} // namespace macadam
