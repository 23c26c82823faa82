#pragma once

#include "mapping/comparison/method_agreement.hpp"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace macadam {

/// Elevations of one wheel track at even stations.
struct TrackProfile {
    std::span<const double> elevation_m; ///< within 1e5 m of 0
    double first_m;                      ///< station of the first elevation
    double step_m;                       ///< 1e-4 <= step_m <= 0.3
};

/// Waveband in which two profiles are compared.
struct ProfileBand {
    std::string_view name;
    double from_m; ///< shortest wavelength; 0 for the band of IRI, which the golden car selects
    double to_m;
};

/// The bands: IRI, and the three of S. M. Karamihas, "Critical Profiler Accuracy Requirements",
/// UMTRI-2005-24, in which profilers are compared.
std::span<const ProfileBand> profile_bands();

/// Agreement of two profiles in one waveband.
struct BandAgreement {
    ProfileBand band;
    double score;       ///< correlation times min(gain, 1/gain): 1 for equal profiles
    double correlation; ///< of the waveforms, -1 to 1
    double gain;        ///< standard deviation of a over that of b
    double lag_m;       ///< station in b minus station in a of the same road
};

/// Minimum mean scores of IRI-filtered profiles for the certification of a profiler (AASHTO R 56).
inline constexpr double min_repeatability_score = 0.92; ///< between its own runs
inline constexpr double min_accuracy_score = 0.90;      ///< of its runs and a reference profile

struct ProfileComparisonConfig {
    double max_lag_m = 5;   ///< maximum shift of one profile along the other
    double interval_m = 20; ///< length of the intervals whose IRI is compared
};

/// Agreement of two profiles of one wheel track.
struct TrackAgreement {
    double shared_m; ///< length compared
    double iri_a;    ///< mm/m, over that length
    double iri_b;
    std::vector<BandAgreement>
        bands; ///< IRI first; bands that a step is too coarse for are omitted
    std::vector<AgreementPair>
        intervals; ///< IRI of consecutive intervals, numbered from 0 by index
};

/// Compares two profiles of one wheel track by cross-correlation.
///
/// The profiles are filtered in each band: by the golden car (suspension_stroke_mm_per_m), or their
/// slopes by a Butterworth band-pass of order 4 without delay. The first 11 m, in which the golden
/// car settles, are left out, and of the other bands their longest wavelength at both ends (at most
/// an eighth of the profile). The signals are interpolated to points at the finer of both steps,
/// but at least 0.01 m apart, and shifted along each other. The score of a shift is the covariance
/// over the larger variance, which equals the correlation times the ratio of the smaller to the
/// larger standard deviation. The largest score counts, between steps by a parabola. The lag of IRI
/// is sought within `max_lag_m`, those of the bands within 0.5 m of it.
///
/// A band is omitted if a profile has fewer than two points in its shortest wavelength.
///
/// \param way_id  of the keys of the intervals; tells tracks apart.
/// \throws InputError  if the profiles share less than 20 m, at every lag, or a step or an
/// elevation
///                     is out of bounds.
///
/// Source: S. M. Karamihas, "Development of cross correlation for objective comparison of
/// profiles", UMTRI-2002-36; AASHTO R 56, "Certification of inertial profiling systems".
TrackAgreement compare_tracks(const TrackProfile& a,
                              const TrackProfile& b,
                              std::int64_t way_id,
                              const ProfileComparisonConfig& config);

} // namespace macadam
