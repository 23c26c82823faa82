#pragma once

#include "render/projection/tile_pixel_grid.hpp"
#include "render/scene/scene.hpp"

#include <cstdint>
#include <vector>

namespace macadam::testing {

/// A line through places in pixels from the corner of a window.
MapLine line_at(const WorldWindow& window,
                const std::vector<PointEn>& places_px,
                int iri_class,
                int rank = 3);

/// A made-up town of streets with bends, both ways and one way, measured and not, certain and not,
/// in pieces of about 20 px of one class each, with a motorway in long straights across it and
/// hairpins. It fills `window` and reaches out of it. Always the same.
std::vector<MapLine> town_in(const WorldWindow& window, double block_px);

} // namespace macadam::testing
