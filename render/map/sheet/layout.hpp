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
    double unit = 1;       ///< of title, legend and scale: their sizes are for 1000 px a side
    double paper_unit = 1; ///< of roads and their names: 1/96 inch on paper, px
    double width_px = 0;   ///< of the sheet
    PixelBox whole_map;    ///< between header and footer
    PixelBox map;          ///< the same without a band for the legend
    std::vector<PositionedText> texts;
    PixelBox scale_room; ///< area of north arrow and scale bar
    bool scale_bar = true;
    bool is_on_paper = false; ///< the scale is stated beside the bar
    bool edges = true;        ///< hairlines around the map
};

/// Returns the pixels of 1/96 inch on paper; of a picture that a page scales, unit_of.
double paper_unit_of(const PictureSize& size);

/// Returns the unit of the elements around the map. Of a sheet up to 265 mm it is one thousandth of
/// the shorter side, or more for small pictures, so that their text remains legible; on larger
/// sheets it grows with the square root of the side, since they are looked at from further away.
double unit_of(const PictureSize& size);

Layout layout_of(const MapScene& scene, const PictureSize& size, TypeSetter& setter);

/// Shrinks `box` by `margin` on every side.
PixelBox inset(const PixelBox& box, double margin);

} // namespace macadam
