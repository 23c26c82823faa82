#pragma once

#include "render/canvas/draw_target.hpp"
#include "render/scene/scene.hpp"

#include <cstdint>

namespace macadam {

/// Anti-aliased drawing of shapes and text onto a picture, or onto some of its rows.
class Canvas final : public DrawTarget {
public:
    /// \param top_px  row of the picture at which `image` begins
    explicit Canvas(Image image, int top_px = 0) : image_{std::move(image)}, top_px_{top_px} {}

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

    /// Lays a picture on this one. \param left_px, top_px  of its corner
    void lay(const Image& picture, int left_px, int top_px);

    Image finished() && { return std::move(image_); }

private:
    template <typename Coverage>
    void blend(const PixelBox& box, std::uint32_t rgb, Coverage coverage);

    Image image_;
    int top_px_;
};

} // namespace macadam
