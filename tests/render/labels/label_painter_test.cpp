#include "render/labels/label_painter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace macadam::testing {
namespace {

TextMask blank(int width, int height) {
    TextMask mask{3, -2, width, height, {}};
    mask.coverage.resize(std::size_t(width * height));
    return mask;
}

/// By its definition: the most that any pixel of the ink gives, by its distance.
TextMask halo_by_definition(const TextMask& ink, double radius_px) {
    const int side = int(std::ceil(radius_px));
    TextMask halo{ink.left - side, ink.top - side, ink.width + 2 * side, ink.height + 2 * side, {}};
    for (int y = 0; y < halo.height; ++y) {
        for (int x = 0; x < halo.width; ++x) {
            int most = 0;
            for (int v = 0; v < ink.height; ++v) {
                for (int u = 0; u < ink.width; ++u) {
                    const double apart_px = std::hypot(x - side - u, y - side - v);
                    const double share = std::clamp(radius_px + 0.5 - apart_px, 0.0, 1.0);
                    const int inked = ink.coverage[std::size_t(v * ink.width + u)];
                    most = std::max(most, int(inked * std::lround(share * 256) / 256));
                }
            }
            halo.coverage.push_back(std::uint8_t(most));
        }
    }
    return halo;
}

void expect_halo_by_definition(const TextMask& ink) {
    for (const double radius_px : {0.6, 1.5, 2.0, 4.3}) {
        const auto halo = halo_of(ink, radius_px);
        const auto expected = halo_by_definition(ink, radius_px);
        EXPECT_EQ(halo.left, expected.left);
        EXPECT_EQ(halo.top, expected.top);
        EXPECT_EQ(halo.width, expected.width);
        EXPECT_TRUE(halo.coverage == expected.coverage) << radius_px;
    }
}

} // namespace

TEST(Halo, IsWhatLiesNearInkOfAnyShape) {
    std::mt19937 random{11};
    for (int i = 0; i < 6; ++i) {
        auto ink = blank(17, 12);
        for (auto& pixel : ink.coverage) {
            pixel = random() % 3 == 0 ? std::uint8_t(random()) : std::uint8_t{0};
        }
        expect_halo_by_definition(ink);
    }
}

TEST(Halo, IsWhatLiesNearInkThatIsFilled) {
    auto ink = blank(20, 16);
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 20; ++x) {
            const double inside_px = 7 - std::hypot(x - 9.3, y - 7.6);
            ink.coverage[std::size_t(y * 20 + x)] =
                std::uint8_t(std::lround(255 * std::clamp(inside_px, 0.0, 1.0)));
        }
    }
    expect_halo_by_definition(ink);
}

} // namespace macadam::testing
