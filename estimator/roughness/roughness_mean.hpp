#pragma once

#include "estimator/roughness/roughness_trace.hpp"

namespace macadam {

/// Averages the cells past their lead-in over travel [from_m, to_m]. If there are none, the
/// validity gives the reason and covered_m is 0.
IriMean mean_over(const IriTrace& trace, double from_m, double to_m, const Vehicle& vehicle);

/// Returns the standard deviation of an estimate of `iri_mm_per_m` over `length_m` of road.
///
/// It has two relative parts: one varies along the road and averages out with length; the other,
/// caused by the car's parameters and, at speed, by the method's filters, is common to all
/// positions. See docs/method/estimation.md for the figures and their sources.
double sd_of_kf_mm_per_m(double iri_mm_per_m,
                         double length_m,
                         double speed_mps,
                         bool lateral_only,
                         const Vehicle& vehicle);

} // namespace macadam
