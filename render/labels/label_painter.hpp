#pragma once

#include "render/canvas/canvas.hpp"
#include "render/canvas/draw_target.hpp"
#include "render/labels/label_placement.hpp"

#include <cstdint>
#include <span>

namespace macadam {

/// 0xRRGGBB.
struct LabelInks {
    std::uint32_t ink;
    std::uint32_t quiet_ink;
    std::uint32_t halo;
};

/// Draws the frame of a road's number.
///
/// \param box  on the target
void draw_shield(DrawTarget& target, const PixelBox& box, const LabelInks& inks);

/// Pixel of the plane, in whole pixels.
struct PlanePixel {
    int x = 0, y = 0;
};

/// Draws labels onto a canvas that shows a part of the plane of their placement; they are clipped
/// to it. Two canvases that share a pixel of the plane get the same pixel.
///
/// \param corner  top left pixel of the canvas on the plane
void draw_labels(Canvas& canvas,
                 std::span<const Label> labels,
                 const PlanePixel& corner,
                 const LabelInks& inks,
                 TypeSetter& setter);

/// Returns the mask of the letters of a label, at their position on the map.
TextMask label_mask(const Label& label, TypeSetter& setter);

/// Returns the halo within `radius_px` of ink, with soft edges.
TextMask halo_of(const TextMask& ink, double radius_px);

} // namespace macadam
