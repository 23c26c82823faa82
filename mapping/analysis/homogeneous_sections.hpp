#pragma once

#include "mapping/analysis/road_section.hpp"

#include <span>
#include <vector>

namespace macadam {

/// An interval of road with its roughness.
struct ProfilePiece {
    double from_m;
    double to_m;
    double iri; ///< mm/m
};

struct HomogeneousConfig {
    double min_length_m = 200; ///< shortest section
    /// Cost of a section boundary, in squared scatter per typical interval. Twice the Bayesian
    /// information criterion of two more parameters (level and position), because the roughness of
    /// neighbouring intervals is not independent.
    double penalty = 4;
    double min_scatter_mm_per_m = 0.05; ///< lower bound of the scatter, however even the road
};

/// Cuts a road into sections of homogeneous roughness. Minimises the sum of squared deviations from
/// the section means, weighted by length, plus for each boundary `penalty` times the scatter of
/// neighbours, the typical length and ln n. The scatter comes from differences of neighbours
/// (median absolute deviation), so that a change does not count as scatter.
///
/// \param whole_m  length of the road; the sections cover [0, whole_m].
/// \param profile  measured intervals in order; a gap belongs to the section before it.
/// \returns        at least one section if whole_m > 0; exactly one if fewer than two intervals are
/// measured.
///
/// O(n^2). Source: B. Jackson et al., "An algorithm for optimal partitioning of data on an
/// interval", IEEE Signal Processing Letters 12 (2005), pp. 105-108; here with a minimum length.
std::vector<RouteMeasureRange> homogeneous_sections(double whole_m,
                                                    std::span<const ProfilePiece> profile,
                                                    const HomogeneousConfig& config = {});

} // namespace macadam
