#pragma once

#include "render/canvas/draw_target.hpp"
#include "render/scene/colour.hpp"
#include "render/scene/scene.hpp"

#include <span>

namespace macadam {

/// Draws the symbol of an event: a disc for a pothole, a triangle for a bump, a square for a joint,
/// a diamond for rails; larger with severity.
///
/// \param unit  pixels of the picture for one of a picture of 1000 px
void draw_event(DrawTarget& canvas,
                const MapEvent& event,
                const PixelPoint& middle,
                double unit,
                const Palette& colours);

/// Draws the events that lie on the map, the most severe on top.
void draw_events(DrawTarget& canvas,
                 std::span<const MapEvent> events,
                 const MapFrame& frame,
                 const PixelBox& map,
                 double unit,
                 const Palette& colours);

} // namespace macadam
