#pragma once

#include "estimator/roughness/roughness_trace.hpp"

namespace macadam {

/// The mean over travel [from_m, to_m], of the cells past their lead-in. Where none is, the
/// validity says why and covered_m is 0.
IriMean mean_over(const IriTrace& trace, double from_m, double to_m, const Vehicle& vehicle);

/// Standard deviation of an estimate of `iri_mm_per_m` over `length_m` of road.
///
/// Two relative parts: what changes along the road and averages out with length, and what the car's
/// parameters and, at speed, the method's filters shift alike everywhere. See
/// docs/method/estimation.md for the figures and where they come from.
double sd_of_kf_mm_per_m(double iri_mm_per_m,
                         double length_m,
                         double speed_mps,
                         bool lateral_only,
                         const Vehicle& vehicle);

} // namespace macadam
