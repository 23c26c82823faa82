#include "render/labels/label_painter.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

/// Returns a disc with a soft edge: coverage in 1/256 of the pixels around its centre, row by row.
std::vector<std::uint16_t> disc(double radius_px) {
    const int side = int(std::ceil(radius_px));
    std::vector<std::uint16_t> shares;
    for (int dy = -side; dy <= side; ++dy) {
        for (int dx = -side; dx <= side; ++dx) {
            const double apart_px = std::sqrt(double(dx * dx + dy * dy));
            const double share = std::clamp(radius_px + 0.5 - apart_px, 0.0, 1.0);
            shares.push_back(std::uint16_t(std::lround(share * 256)));
        }
    }
    return shares;
}

/// Returns true if the pixel has four neighbours with as much ink or more. Any point it reaches is
/// nearer to one of them, which reaches further.
bool is_inside(const TextMask& ink, int x, int y) {
    if (x == 0 || y == 0 || x + 1 == ink.width || y + 1 == ink.height) {
        return false;
    }
    const auto* at = ink.coverage.data() + std::size_t(y) * std::size_t(ink.width) + x;
    return at[-1] >= *at && at[1] >= *at && at[-ink.width] >= *at && at[ink.width] >= *at;
}

} // namespace

TextMask halo_of(const TextMask& ink, double radius_px) {
    if (ink.coverage.empty()) {
        return {};
    }
    const auto shares = disc(radius_px);
    const int side = int(std::ceil(radius_px));
    const int across = 2 * side + 1;
    TextMask halo{ink.left - side, ink.top - side, ink.width + 2 * side, ink.height + 2 * side, {}};
    halo.coverage.resize(std::size_t(halo.width) * std::size_t(halo.height));
    for (int y = 0; y < ink.height; ++y) {
        for (int x = 0; x < ink.width; ++x) {
            const unsigned inked =
                ink.coverage[std::size_t(y) * std::size_t(ink.width) + std::size_t(x)];
            auto* const corner =
                halo.coverage.data() + std::size_t(y) * std::size_t(halo.width) + x;
            if (inked == 0) {
                continue;
            }
            if (is_inside(ink, x, y)) {
                auto& middle = corner[std::ptrdiff_t(side) * halo.width + side];
                middle = std::max(middle, std::uint8_t(inked));
                continue;
            }
            for (int row = 0; row < across; ++row) {
                const auto* const share = shares.data() + std::ptrdiff_t(row) * across;
                auto* const pixel = corner + std::ptrdiff_t(row) * halo.width;
                for (int i = 0; i < across; ++i) {
                    pixel[i] = std::max(pixel[i], std::uint8_t(inked * share[i] / 256));
                }
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

void draw_shield(DrawTarget& target, const PixelBox& box, const LabelInks& inks) {
    const double line_px = std::max(1.0, std::round(box.height() / 16));
    const double radius_px = box.height() / 5;
    target.fill({box, radius_px}, inks.ink);
    target.fill({{box.left + line_px, box.top + line_px, box.right - line_px, box.bottom - line_px},
                 radius_px - line_px},
                inks.halo);
}

void draw_labels(Canvas& canvas,
                 std::span<const Label> labels,
                 const PlanePixel& corner,
                 const LabelInks& inks,
                 TypeSetter& setter) {
    const PixelPoint origin{double(-corner.x), double(-corner.y)};
    for (const auto& label : labels) {
        const auto mask = label_mask(label, setter);
        if (label.is_shield) {
            const auto& box = label.box;
            draw_shield(canvas,
                        {box.left + origin.x,
                         box.top + origin.y,
                         box.right + origin.x,
                         box.bottom + origin.y},
                        inks);
        } else {
            canvas.write(halo_of(mask, label.halo_px), origin, inks.halo);
        }
        canvas.write(mask, origin, label.quiet ? inks.quiet_ink : inks.ink);
    }
}

} // namespace macadam
