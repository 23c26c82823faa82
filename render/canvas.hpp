#pragma once

#include "render/map.hpp"
#include "render/pen.hpp"

#include <cstdint>

namespace macadam {

/// Draws shapes and text onto a picture, with smooth edges.
class Canvas final : public Pen {
public:
    explicit Canvas(Image image) : image_{std::move(image)} {}

    void fill(const RoundedBox& shape, std::uint32_t rgb) override;
    void stroke(const PixelPoint& from,
                const PixelPoint& to,
                double radius_px,
                std::uint32_t rgb) override;
    void fill_triangle(const PixelPoint& a,
                       const PixelPoint& b,
                       const PixelPoint& c,
                       std::uint32_t rgb) override;
    void write(const TextMask& text, const PixelPoint& at, std::uint32_t rgb) override;

    Image finished() && { return std::move(image_); }

private:
    template <typename Coverage>
    void blend(const PixelBox& box, std::uint32_t rgb, Coverage coverage);

    Image image_;
};

} // namespace macadam
