#pragma once

#include "render/gl_context.hpp"
#include "render/ribbon.hpp"

#include <cstdint>
#include <memory>
#include <span>

namespace macadam {

inline constexpr int most_ribbon_window_px = 8192; ///< side of a context's picture

/// Draws ribbons into a context's picture. A pixel's share of the ribbon is computed from its
/// distance to the centre line, so edges are smooth without drawing more pixels than the picture
/// has.
class RibbonPainter {
public:
    /// \param context  of most_ribbon_window_px a side at most
    explicit RibbonPainter(const GlContext& context);
    ~RibbonPainter();

    /// Fills a box of whole pixels with a colour; what is drawn later stays inside it.
    void clear(const PixelBox& box, std::uint32_t rgb);

    void draw(std::span<const RibbonQuad> quads, std::uint32_t rgb, double radius_px);

    /// Returns when the memory holds the picture.
    void finish();

private:
    struct Gl;
    std::unique_ptr<Gl> gl_;
};

} // namespace macadam
