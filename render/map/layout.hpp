#pragma once

#include "render/projection/projection.hpp"
#include "render/scene/scene.hpp"
#include "render/text/text_shaping.hpp"

#include <string>
#include <vector>

namespace macadam {

struct PlacedText {
    std::string text;
    TextLook look;
    PixelPoint at; ///< left end of the base line
    bool quiet = false;
};

/// How the sheet is divided: title above, map, scale bar and attribution below.
struct Layout {
    double unit = 1; ///< what one pixel of a picture of 1000 px has become
    PixelBox map;
    std::vector<PlacedText> texts;
    PixelBox scale_room; ///< for north arrow and scale bar
    bool scale_bar = true;
    bool edges = true; ///< hairlines between the map and what is around it
};

/// One thousandth of the shorter side; small pictures get more, so that their text can be read.
double unit_of(int width_px, int height_px);

Layout layout_of(const MapScene& scene, int width_px, int height_px, TypeSetter& setter);

/// `box` made smaller by `margin` on every side.
PixelBox inset(const PixelBox& box, double margin);

} // namespace macadam
