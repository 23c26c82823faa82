#pragma once

#include "render/map.hpp"
#include "render/projection.hpp"
#include "render/text.hpp"

#include <cstdint>

namespace macadam {

struct RoundedBox {
    PixelBox box;
    double radius_px = 0;
};

/// Draws shapes and text onto a picture, with smooth edges. What lies outside is left out.
class Canvas {
public:
    explicit Canvas(Image image) : image_{std::move(image)} {}

    void fill(const RoundedBox& shape, std::uint32_t rgb);

    /// A thick line with round ends.
    void stroke(const PixelPoint& from, const PixelPoint& to, double radius_px, std::uint32_t rgb);

    /// Corners in the order of the clock.
    void
    fill_triangle(const PixelPoint& a, const PixelPoint& b, const PixelPoint& c, std::uint32_t rgb);

    /// \param at  left end of the base line
    void write(const TextMask& text, const PixelPoint& at, std::uint32_t rgb);

    Image finished() && { return std::move(image_); }

private:
    template <typename Coverage>
    void blend(const PixelBox& box, std::uint32_t rgb, Coverage coverage);

    Image image_;
};

} // namespace macadam
