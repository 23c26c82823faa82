#pragma once

#include "render/projection/projection.hpp"
#include "render/text/text_shaping.hpp"

#include <cstdint>

namespace macadam {

struct RoundedBox {
    PixelBox box;
    double radius_px = 0;
};

/// What shapes and text are drawn with: on a picture (Canvas) or on a page of a PDF file (PdfPage).
/// What lies outside is left out.
class DrawTarget {
public:
    DrawTarget() = default;
    DrawTarget(const DrawTarget&) = delete;
    DrawTarget& operator=(const DrawTarget&) = delete;
    virtual ~DrawTarget() = default;

    virtual void fill(const RoundedBox& shape, std::uint32_t rgb) = 0;

    /// A thick line with round ends.
    virtual void
    stroke(const PixelPoint& from, const PixelPoint& to, double radius_px, std::uint32_t rgb) = 0;

    /// Corners in the order of the clock.
    virtual void fill_triangle(const PixelPoint& a,
                               const PixelPoint& b,
                               const PixelPoint& c,
                               std::uint32_t rgb) = 0;

    /// \param at  left end of the base line
    virtual void write(const TextMask& text, const PixelPoint& at, std::uint32_t rgb) = 0;
};

} // namespace macadam
