#pragma once

#include "estimator/roughness/roughness_trace.hpp"
#include "mapping/passes/pass.hpp"

#include <optional>
#include <vector>

namespace macadam {

/// Ratio of HRI to MRI with its standard deviation.
struct HriRatio {
    double hri_over_mri;
    double sd;
};

/// IRI of half the difference of the wheel tracks along one run.
struct DifferenceRun {
    double start_travel_m;
    double cell_m;
    double lead_in_m;
    std::vector<float> centre_mm_per_m; ///< HRI
    std::vector<float> half_mm_per_m;
};

/// Variation of the difference of the wheel tracks along a trip. Its square over HRI² is what MRI
/// has beyond HRI: HRI/MRI = 1/sqrt(1 + r²) if both are Gaussian (docs/method/estimation.md).
///
/// The level of the difference is not used: cars lean on bushes and bars that no file states. It is
/// scaled to the trip's ratio, and what does not grow with HRI is noise.
struct TrackDifference {
    std::vector<DifferenceRun> runs;
    double trip_ratio = hri_over_mri; ///< of the trip's mean HRI to its mean MRI
    double gain = 0;                  ///< half² per HRI² over the trip
    double noise_mm2 = 0;             ///< half² where HRI is 0, (mm/m)²
};

/// Returns the difference of the tracks over the trip; `std::nullopt` if it was not observed over
/// at least a kilometre. The trip's ratio is the usual one unless the axles of the vehicle are
/// stated: what else leans and turns is not known either.
std::optional<TrackDifference> track_difference_of(const IriTrace& trace, const Vehicle& vehicle);

/// Returns the ratio over travel [from_m, to_m], widened to at least 20 m: the usual one where the
/// difference is unknown.
HriRatio ratio_over(const std::optional<TrackDifference>& difference, double from_m, double to_m);

/// Returns the headline, with MRI inferred from HRI by this ratio where the tracks are unknown.
std::optional<Headline> headline_of(const IriMean& mean, const HriRatio& ratio);

} // namespace macadam
