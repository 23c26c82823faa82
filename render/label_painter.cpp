#include "render/label_painter.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

struct Reach {
    int dx, dy;
    int share; ///< of 256
};

/// A disc with a soft edge, as pixels around its middle.
std::vector<Reach> disc(double radius_px) {
    const int side = int(std::ceil(radius_px));
    std::vector<Reach> pixels;
    for (int dy = -side; dy <= side; ++dy) {
        for (int dx = -side; dx <= side; ++dx) {
            const double apart_px = std::sqrt(double(dx * dx + dy * dy));
            const double share = std::clamp(radius_px + 0.5 - apart_px, 0.0, 1.0);
            if (share > 0) {
                pixels.push_back({dx, dy, int(std::lround(share * 256))});
            }
        }
    }
    return pixels;
}

} // namespace

TextMask halo_of(const TextMask& ink, double radius_px) {
    if (ink.coverage.empty()) {
        return {};
    }
    const auto reach = disc(radius_px);
    const int side = int(std::ceil(radius_px));
    TextMask halo{ink.left - side, ink.top - side, ink.width + 2 * side, ink.height + 2 * side, {}};
    halo.coverage.resize(std::size_t(halo.width) * std::size_t(halo.height));
    for (int y = 0; y < ink.height; ++y) {
        for (int x = 0; x < ink.width; ++x) {
            const int inked = ink.coverage[std::size_t(y) * ink.width + x];
            if (inked == 0) {
                continue;
            }
            for (const auto& [dx, dy, share] : reach) {
                auto& pixel = halo.coverage[std::size_t(y + dy + side) * halo.width +
                                            std::size_t(x + dx + side)];
                pixel = std::max(pixel, std::uint8_t(inked * share / 256));
            }
        }
    }
    return halo;
}

TextMask label_mask(const Label& label, TypeSetter& setter) {
    std::vector<TextMask> stamps;
    stamps.reserve(label.glyphs.size());
    for (const auto& [glyph, pose] : label.glyphs) {
        stamps.push_back(setter.stamp(glyph, label.look, pose));
    }
    auto mask = merged(stamps);
    mask.left += label.left;
    mask.top += label.top;
    return mask;
}

void draw_labels(Canvas& canvas,
                 std::span<const Label> labels,
                 const PlanePixel& corner,
                 const LabelInks& inks,
                 TypeSetter& setter) {
    const PixelPoint origin{double(-corner.x), double(-corner.y)};
    for (const auto& label : labels) {
        const auto mask = label_mask(label, setter);
        canvas.write(halo_of(mask, label.halo_px), origin, inks.halo);
        canvas.write(mask, origin, label.quiet ? inks.quiet_ink : inks.ink);
    }
}

} // namespace macadam
