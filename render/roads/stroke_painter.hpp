#pragma once

#include "render/gl/gl_context.hpp"
#include "render/roads/stroke_geometry.hpp"

#include <cstdint>
#include <memory>
#include <span>

namespace macadam {

inline constexpr int max_stroke_window_px = 8192; ///< side of a context's picture

/// Draws ribbons into a context's picture. A pixel's share of the ribbon is computed from its
/// distance to the centre line, so edges are smooth without drawing more pixels than the picture
/// has.
class StrokePainter {
public:
    /// \param context  of max_stroke_window_px a side at most
    explicit StrokePainter(const GlContext& context);
    ~StrokePainter();

    /// Fills a box of whole pixels with a colour; what is drawn later stays inside it.
    void clear(const PixelBox& box, std::uint32_t rgb);

    void draw(std::span<const StrokeQuad> quads, std::uint32_t rgb, double radius_px);

    /// Returns when the memory holds the picture.
    void finish();

private:
    struct Gl;
    std::unique_ptr<Gl> gl_;
};

} // namespace macadam
