#pragma once

#include "render/projection/projection.hpp"
#include "render/scene/scene.hpp"
#include "render/text/text_shaping.hpp"

#include <string>
#include <vector>

namespace macadam {

struct PositionedText {
    std::string text;
    TextLook look;
    PixelPoint at; ///< left end of the baseline
    bool quiet = false;
};

/// Division of the sheet: title above, map, scale bar and attribution below.
struct Layout {
    double unit = 1; ///< size of one pixel of a 1000 px picture
    PixelBox map;
    std::vector<PositionedText> texts;
    PixelBox scale_room; ///< area of north arrow and scale bar
    bool scale_bar = true;
    bool edges = true; ///< hairlines around the map
};

/// Returns one thousandth of the shorter side, or more for small pictures, so that their text
/// remains legible.
double unit_of(int width_px, int height_px);

Layout layout_of(const MapScene& scene, int width_px, int height_px, TypeSetter& setter);

/// Shrinks `box` by `margin` on every side.
PixelBox inset(const PixelBox& box, double margin);

} // namespace macadam
