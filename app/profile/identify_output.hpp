#pragma once

#include "app/profile/locate_on_profile.hpp"
#include "estimator/identification/likelihood/likelihood_fit.hpp"
#include "estimator/identification/spectrum_fit.hpp"

#include <string>

namespace macadam {

/// Result of `macadam identify` as text for each form of output.
struct IdentifyOutput {
    std::string table;
    std::string json;
    std::string csv;    ///< a row for each parameter
    std::string figure; ///< SVG: spectra of every channel, before and after the fit
};

/// \param identified  the vehicle that is written
IdentifyOutput output_of(const SpectrumFit& fit,
                         const ProfileResponse& ride,
                         const ProfilePosition& place,
                         const Vehicle& identified);
IdentifyOutput
output_of(const LikelihoodFit& fit, const ProfilePosition& place, const Vehicle& identified);

} // namespace macadam
