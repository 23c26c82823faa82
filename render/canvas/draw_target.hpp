#pragma once

#include "render/projection/projection.hpp"
#include "render/text/text_shaping.hpp"

#include <cstdint>

namespace macadam {

struct RoundedBox {
    PixelBox box;
    double radius_px = 0;
};

/// Target of drawing: a picture (Canvas) or a page of a PDF file (PdfPage). Shapes and text are
/// clipped to it.
class DrawTarget {
public:
    DrawTarget() = default;
    DrawTarget(const DrawTarget&) = delete;
    DrawTarget& operator=(const DrawTarget&) = delete;
    virtual ~DrawTarget() = default;

    virtual void fill(const RoundedBox& shape, std::uint32_t rgb) = 0;

    /// Draws a thick line with round ends.
    virtual void
    stroke(const PixelPoint& from, const PixelPoint& to, double radius_px, std::uint32_t rgb) = 0;

    /// Fills a triangle with its corners in clockwise order.
    virtual void fill_triangle(const PixelPoint& a,
                               const PixelPoint& b,
                               const PixelPoint& c,
                               std::uint32_t rgb) = 0;

    /// \param at  left end of the baseline
    virtual void write(const TextMask& text, const PixelPoint& at, std::uint32_t rgb) = 0;
};

} // namespace macadam
