#pragma once

#include "mapping/style/iri_class.hpp"
#include "mapping/tiles/tile_features.hpp"

#include <vector>

namespace macadam {

/// How coarse a map of a zoom is. Pixels are those of a tile of 256.
struct Generalisation {
    double pixel;        ///< in world units
    double min_run_px;   ///< shorter runs of one class go to a neighbour along the road
    double cell_px;      ///< roads that fit in a square of this size are drawn as one
    double tolerance_px; ///< lines are simplified by so much
};

/// From this zoom on every segment is drawn by itself.
inline constexpr int segments_from_zoom = 14;
/// Below this zoom both directions are one line.
inline constexpr int directions_from_zoom = 12;

/// What is drawn where segments are not: from zoom 13 on runs of one class and validity as they
/// are, below it none shorter than 2 pixels and no road smaller than 1.
///
/// \param step  of coarsening, for tiles that would be too large: each doubles lengths and squares,
///              and the first two the tolerance.
Generalisation generalisation_at(int zoom, int step = 0);

/// Parts joined to as few as the zoom can show. What each part counts, its length by class, is in
/// exactly one of those that come out.
///
/// 1. Parts that follow one another on one road (same name, or none and the same class of road) and
///    go on without a turn of more than 60 degrees are joined while class and validity are the
///    same. Where more than two meet the straightest go on.
/// 2. A run shorter than `min_run_px` joins its neighbour on the road that is nearest in IRI, the
///    shortest first. The class of a run is that of its mean IRI, weighted by length.
/// 3. Roads that fit in a square of `cell_px` go together with all others in the same square of a
///    grid: the longest is drawn, with the mean of all.
/// 4. Lines are simplified; they keep their ends and the places where others end.
///
/// \param parts  each with the same number of classes as the table.
/// \returns      in the order of `first`.
std::vector<RoadPart>
generalised(std::vector<RoadPart> parts, const Generalisation& how, const ClassTable& table);

} // namespace macadam
