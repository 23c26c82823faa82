#pragma once

#include "render/gl_context.hpp"
#include "render/ribbon.hpp"

#include <cstdint>
#include <memory>
#include <span>

namespace macadam {

/// Draws ribbons into a context's picture. A pixel's share of the ribbon is computed from its
/// distance to the centre line, so edges are smooth without drawing more pixels than the picture
/// has.
class RibbonPainter {
public:
    RibbonPainter(const GlContext& context, int width_px, int height_px);
    ~RibbonPainter();

    /// Fills a box with a colour; what is drawn later stays inside it.
    void clear(const PixelBox& box, std::uint32_t rgb);

    void draw(std::span<const RibbonQuad> quads, std::uint32_t rgb, double radius_px);

    /// Returns when the memory holds the picture.
    void finish();

private:
    struct Gl;
    std::unique_ptr<Gl> gl_;
};

} // namespace macadam
