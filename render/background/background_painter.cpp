#include "render/background/background_painter.hpp"

#include "render/background/coverage_mask.hpp"

#include <array>
#include <memory>
#include <utility>

namespace macadam {
namespace {

using Colours = std::array<std::uint32_t, background_kinds>;

// By kind. They keep to the lightness of the ground, so that roads and names stand out; printed in
// grey, water, green and buildings remain apart.
constexpr Colours light{0xeceae4, // built-up
                        0xebf1e1, // meadow
                        0xdbebcd, // park
                        0xd5e5c9, // forest
                        0xb7d4e8, // water
                        0xb7d4e8, // river
                        0xb7d4e8, // stream
                        0xd9d4cb, // building
                        0x97948f, // railway
                        0xb9b6b1};
constexpr Colours dark{0x26262b,
                       0x20261f,
                       0x212d22,
                       0x1e2a20,
                       0x1a3147,
                       0x1a3147,
                       0x1a3147,
                       0x34343b,
                       0x6a6b73,
                       0x4b4c54};
constexpr Colours print{0xf6f5f3,
                        0xf8faf4,
                        0xeff4ea,
                        0xe9f0e3,
                        0xcbdeeb,
                        0xcbdeeb,
                        0xcbdeeb,
                        0xe0ded9,
                        0x8f8f8f,
                        0xb4b4b4};

bool meets(const PixelBox& box, const PicturePart& part) {
    return box.left < part.left_px + part.width_px && box.right > part.left_px &&
           box.top < part.top_px + part.height_px && box.bottom > part.top_px;
}

std::vector<std::uint8_t> filled(const PicturePart& part, std::uint32_t rgb) {
    constexpr std::uint8_t opaque = 255;
    std::vector<std::uint8_t> rgba(std::size_t(part.width_px) * std::size_t(part.height_px) * 4,
                                   opaque);
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        rgba[i] = static_cast<std::uint8_t>(rgb >> 16U);
        rgba[i + 1] = static_cast<std::uint8_t>(rgb >> 8U);
        rgba[i + 2] = static_cast<std::uint8_t>(rgb);
    }
    return rgba;
}

} // namespace

std::uint32_t background_colour(BackgroundKind kind, MapStyle::Theme theme) {
    const auto& colours = theme == MapStyle::Theme::dark    ? dark
                          : theme == MapStyle::Theme::print ? print
                                                            : light;
    return colours[static_cast<std::size_t>(kind)];
}

PaintPart painted_background(std::vector<BackgroundShape> shapes,
                             MapStyle::Theme theme,
                             std::uint32_t ground_rgb,
                             std::optional<BackgroundFade> fade) {
    return [shapes = std::make_shared<const std::vector<BackgroundShape>>(std::move(shapes)),
            theme,
            ground_rgb,
            fade](const PicturePart& part) {
        auto rgba = filled(part, ground_rgb);
        CoverageMask mask{part};
        for (std::size_t i = 0; i < shapes->size(); ++i) {
            const auto& shape = (*shapes)[i];
            if (meets(shape.box, part)) {
                for (const auto& ring : shape.rings) {
                    mask.add(ring);
                }
            }
            if (i + 1 == shapes->size() || (*shapes)[i + 1].kind != shape.kind) {
                mask.paint(rgba, background_colour(shape.kind, theme));
            }
        }
        if (fade) {
            macadam::fade(*fade, part, ground_rgb, rgba);
        }
        return rgba;
    };
}

} // namespace macadam
