#pragma once

#include "mapping/style/iri_class.hpp"
#include "mapping/tiles/tile_features.hpp"

#include <vector>

namespace macadam {

/// Generalisation of a zoom level. Pixels refer to tiles of 256 pixels.
struct Generalisation {
    double pixel;        ///< in world units
    double min_run_px;   ///< shorter runs of one class are merged with a neighbour along the road
    double cell_px;      ///< roads within a square of this size are drawn as one
    double tolerance_px; ///< tolerance of line simplification
};

/// Lowest zoom at which single segments are drawn.
inline constexpr int segments_from_zoom = 14;
/// Lowest zoom at which the directions are drawn separately.
inline constexpr int directions_from_zoom = 12;

/// Returns the generalisation below segments_from_zoom: at zoom 13 runs of one class and validity
/// are unchanged; below it no run is shorter than 2 pixels and no road smaller than 1.
///
/// \param step  of coarsening, for tiles that would be too large: each doubles lengths and squares,
///              and the first two the tolerance.
Generalisation generalisation_at(int zoom, int step = 0);

/// Joins parts to as few as the zoom can show. The length by class of each input part is counted in
/// exactly one output part.
/// 1. Parts that follow one another on one road (same name, or none and the same class of road)
///    without a turn of more than 60 degrees are joined while class and validity are equal. Where
///    more than two meet, the straightest pair continues.
/// 2. A run shorter than `min_run_px` joins the neighbour on the road that is nearest in IRI, the
///    shortest run first. The class of a run is that of its length-weighted mean IRI.
/// 3. Roads within a square of `cell_px` are merged with all others in the same square of a grid:
///    the longest is drawn, with the mean of all.
/// 4. Lines are simplified; they keep their ends and the ends of other lines on them.
///
/// \param parts  each with the same number of classes as the table.
/// \returns      in the order of `first`.
std::vector<RoadPart>
generalised(std::vector<RoadPart> parts, const Generalisation& how, const ClassTable& table);

} // namespace macadam
