#pragma once

#include "render/gl/gl_context.hpp"
#include "render/roads/stroke_geometry.hpp"

#include <cstdint>
#include <memory>
#include <span>

namespace macadam {

inline constexpr int max_stroke_window_px = 8192; ///< maximum side of a context's picture

/// Draws strokes into a context's picture. Coverage is computed from a pixel's distance to the
/// centre line, so edges are smooth without supersampling.
class StrokePainter {
public:
    /// \param context  at most max_stroke_window_px a side
    explicit StrokePainter(const GlContext& context);
    ~StrokePainter();

    /// Fills a box of whole pixels with a colour; later drawing is clipped to it.
    void clear(const PixelBox& box, std::uint32_t rgb);

    void draw(std::span<const StrokeQuad> quads, std::uint32_t rgb, double radius_px);

    /// Waits until the memory contains the picture.
    void finish();

private:
    struct Gl;
    std::unique_ptr<Gl> gl_;
};

} // namespace macadam
