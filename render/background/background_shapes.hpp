#pragma once

#include "mapping/background/background.hpp"
#include "mapping/background/background_pieces.hpp"
#include "render/projection/projection.hpp"

#include <span>
#include <vector>

namespace macadam {

/// Part of the background on a picture: polygons, also those that outline the strokes of lines.
/// Holes run against their outer rings.
struct BackgroundShape {
    BackgroundKind kind;
    PixelBox box; ///< around all rings
    std::vector<std::vector<PixelPoint>> rings;
};

/// Style of a background at a scale.
struct BackgroundLook {
    double unit = 1;    ///< size of one pixel of a 1000 px picture
    double denominator; ///< scale of the map, 1:N
};

/// Projects the pieces of tiles that lie on `room`, sorted by kind from the lowest layer.
///
/// \param middle_deg  longitude around which a map across the antimeridian lies
/// \throws InputError  if the pieces are damaged.
std::vector<BackgroundShape> background_shapes(std::span<const BackgroundTile> tiles,
                                               const MapFrame& frame,
                                               const PixelBox& room,
                                               const BackgroundLook& look,
                                               double middle_deg);

} // namespace macadam
