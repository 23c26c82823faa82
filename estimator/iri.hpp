#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace macadam {

/// One value of the rectified suspension stroke per step of a profile, mm/m: its mean over any
/// part is the IRI of that part. The golden car runs through the whole without a restart.
///
/// ASTM E1926 at the profile's own step: mean slope over the 250 mm of the tyre's contact (the
/// nearest whole number of steps, at least one), exact state transition, start at the mean slope
/// over the first 11 m.
///
/// \param elevation_m  n evenly spaced elevations of one wheel track, any datum. n >= 2.
/// \param step_m       0 < step_m <= 0.3: a coarser profile has lost what IRI weighs most.
/// \param envelope     false: the profile is already smoothed over the tyre's contact.
/// \returns            n - k values, k = steps in 250 mm (1 without envelope): value i belongs to
///                     [i, i + 1) * step_m.
/// \throws InputError  if a precondition does not hold or an elevation is not finite.
///
/// Source: ASTM E1926; M. W. Sayers, "On the calculation of International Roughness Index from
/// longitudinal road profile", Transportation Research Record 1501 (1995), pp. 1-12.
std::vector<float>
rectified_stroke_mm_per_m(std::span<const double> elevation_m, double step_m, bool envelope = true);

/// Mean of the above: 0 for a smooth plane; about 1 for a new motorway, 10 for a broken track.
/// The first 11 m only set the car in motion, so a stretch much shorter than 50 m says little.
double iri_mm_per_m(std::span<const double> elevation_m, double step_m, bool envelope = true);

/// The profile between two stations, on uneven stations: the golden car over the straight lines
/// between them, solved exactly, after a continuous 250 mm moving average.
///
/// \param station_m  rising, as many as elevation_m; steps of 0.3 m in the mean and 0.6 m each at
///                   most.
/// \param edges_m    m + 1 rising borders of segments within the stations.
/// \returns          m means of the rectified stroke, integrated with its zero crossings.
std::vector<double> exact_iri_mm_per_m(std::span<const double> station_m,
                                       std::span<const double> elevation_m,
                                       std::span<const double> edges_m,
                                       bool envelope = true);

inline constexpr double golden_speed_mps = 80 / 3.6; ///< ASTM E1926
inline constexpr double contact_patch_m = 0.25;      ///< ASTM E1926: base of the moving average
inline constexpr double start_up_m = 11;             ///< ASTM E1926: 0.5 s at 80 km/h
inline constexpr double coarsest_step_m = 0.3;

} // namespace macadam
