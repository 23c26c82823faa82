#include "render/tiles/tile_png.hpp"

#include "render/background/background_painter.hpp"
#include "render/scene/colour.hpp"
#include "render/tiles/tile_painter.hpp"
#include "tile_scene.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <cstdlib>

namespace macadam::testing {
namespace {

const TileId tile{15, 17000, 11000};

Image town(int across) {
    TilePainter painter{{{}, 256, across}};
    return painter.draw(tile, town_in(window_of(tile, 256, 2), 60));
}

std::uint32_t pixel(const Image& image, int x, int y) {
    const auto* rgb = image.rgb.data() + (std::size_t(y) * image.width + std::size_t(x)) * 3;
    return std::uint32_t(rgb[0]) << 16 | std::uint32_t(rgb[1]) << 8 | rgb[2];
}

/// As libpng reads it.
Image decoded(const std::vector<std::uint8_t>& bytes) {
    png_image read{};
    read.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_memory(&read, bytes.data(), bytes.size()), 0)
        << read.message;
    EXPECT_NE(read.format & PNG_FORMAT_FLAG_COLORMAP, 0U);
    read.format = PNG_FORMAT_RGB;
    Image image{int(read.width), int(read.height), std::vector<std::uint8_t>(PNG_IMAGE_SIZE(read))};
    EXPECT_NE(png_image_finish_read(&read, nullptr, image.rgb.data(), 0, nullptr), 0);
    return image;
}

double root_mean_square(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) {
        const double off = int(a.rgb[i]) - int(b.rgb[i]);
        sum += off * off;
    }
    return std::sqrt(sum / double(a.rgb.size()));
}

} // namespace

TEST(TilePng, ShowsEachPixelInTheColourOfThePaletteThatStandsForIt) {
    const auto image = town(1);
    TilePng png{MapStyle{}};
    const auto read = decoded(png.encode(image, {0, 0, 256}));
    ASSERT_EQ(read.width, 256);
    ASSERT_EQ(read.height, 256);
    std::size_t wrong = 0;
    for (int i = 0; i < 256 * 256; ++i) {
        wrong += pixel(read, i % 256, i / 256) != png.shown(pixel(image, i % 256, i / 256));
    }
    EXPECT_EQ(wrong, 0U);
    // Between two steps of the palette lie some 20 levels, and most of a tile is exact.
    EXPECT_LT(root_mean_square(read, image), 2);
}

TEST(TilePng, KeepsTheColoursOfTheStyle) {
    for (const auto theme :
         {MapStyle::Theme::light, MapStyle::Theme::dark, MapStyle::Theme::print}) {
        for (const auto* ramp : {"rdylbu", "cividis", "viridis"}) {
            const auto* five = class_table("five");
            MapStyle style{.theme = theme, .ramp = ramp, .classes = five};
            TilePng with_background{style, true};
            for (std::size_t i = 0; i < background_kinds; ++i) {
                const auto rgb = background_colour(static_cast<BackgroundKind>(i), theme);
                EXPECT_EQ(with_background.shown(rgb), rgb);
            }
            EXPECT_LE(with_background.palette().size(), 255U);
            TilePng png{style};
            const auto colours = palette(theme);
            EXPECT_EQ(png.shown(colours.ground), colours.ground);
            EXPECT_EQ(png.shown(colours.casing), colours.casing);
            EXPECT_EQ(png.shown(colours.unmeasured), colours.unmeasured);
            for (const auto rgb : ramp_colours(ramp, five->classes.size())) {
                EXPECT_EQ(png.shown(rgb), rgb);
            }
            EXPECT_LE(png.palette().size(), 255U);
        }
    }
}

TEST(TilePng, CutsTilesOutOfALargePictureAsTheyAreDrawnAlone) {
    const auto large = town(2);
    TilePng png{MapStyle{}};
    TilePng another{MapStyle{}};
    TilePainter painter{{{}, 256, 1}};
    const auto alone =
        painter.draw({tile.zoom, tile.x + 1, tile.y + 1}, town_in(window_of(tile, 256, 2), 60));
    EXPECT_EQ(png.encode(large, {256, 256, 256}), another.encode(alone, {0, 0, 256}));
}

TEST(TilePng, HasAnEmptyTileWithoutDrawingOne) {
    TilePng png{MapStyle{}};
    TilePainter painter{{{}, 256, 1}};
    EXPECT_EQ(png.empty(256), png.encode(painter.draw(tile, {}), {0, 0, 256}));
    EXPECT_LT(png.empty(256).size(), 400U);
}

} // namespace macadam::testing
