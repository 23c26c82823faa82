#pragma once

#include "mapping/analysis/road_section.hpp"

#include <span>
#include <vector>

namespace macadam {

/// A piece of road with its roughness, on a ruler.
struct ProfilePiece {
    double from_m;
    double to_m;
    double iri; ///< mm/m
};

struct HomogeneousConfig {
    double min_length_m = 200; ///< of a section
    /// What a border must explain, in squared scatter per typical piece: twice the Bayesian
    /// information criterion of two more parameters (level and place), because roughness of
    /// neighbouring pieces is not independent.
    double penalty = 4;
    double min_scatter_mm_per_m = 0.05; ///< what borders are not worth, on however even a road
};

/// Cuts a road where its roughness changes: the sections with the least sum of squared deviations
/// from their means, weighted by length, plus for every border `penalty` times the scatter of
/// neighbours, the typical length and ln n. The scatter is taken from differences of neighbours
/// (median absolute deviation), so that a change does not count as scatter.
///
/// \param whole_m  of the road: the sections reach from 0 to it.
/// \param profile  measured pieces in order; what lies between goes to the section before it.
/// \returns        at least one section if whole_m > 0; one where fewer than two pieces are known.
///
/// O(n^2). Source: B. Jackson et al., "An algorithm for optimal partitioning of data on an
/// interval", IEEE Signal Processing Letters 12 (2005), pp. 105-108; here with a least length.
std::vector<RouteMeasureRange> homogeneous_sections(double whole_m,
                                                    std::span<const ProfilePiece> profile,
                                                    const HomogeneousConfig& config = {});

} // namespace macadam
