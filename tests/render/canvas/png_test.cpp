#include "render/canvas/png.hpp"

#include "render/canvas/palette_png.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <vector>

namespace macadam::testing {
namespace {

std::vector<std::uint8_t> pixels_of(const std::vector<std::uint8_t>& file) {
    png_image read{};
    read.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_memory(&read, file.data(), file.size()), 0);
    read.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(read));
    EXPECT_NE(png_image_finish_read(&read, nullptr, rgb.data(), 0, nullptr), 0);
    return rgb;
}

/// Returns a picture of a flat area above a slow transition, with a colour per pixel in its last
/// rows, as antialiased letters have.
Image area_and_transition(int last_rows) {
    Image image{.width = 200, .height = 120, .rgb = {}};
    std::mt19937 random{7};
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const int level = std::max(0, y - 40);
            const bool is_last = y >= image.height - last_rows;
            for (const int of_area : {183, 100, 20}) {
                image.rgb.push_back(
                    std::uint8_t(is_last ? int(random() % 256) : of_area + level / 2));
            }
        }
    }
    return image;
}

} // namespace

TEST(PalettePng, KeepsUpTo256Colours) {
    const auto image = area_and_transition(0);
    EXPECT_EQ(pixels_of(encode_palette_png(image)), image.rgb);
}

TEST(PalettePng, KeepsAreasAndTransitionsAmongManyColours) {
    const int last_rows = 10;
    const auto image = area_and_transition(last_rows);
    const auto rgb = pixels_of(encode_palette_png(image));
    ASSERT_EQ(rgb.size(), image.rgb.size());
    const auto exact = std::size_t(image.height - last_rows) * std::size_t(image.width) * 3;
    EXPECT_TRUE(std::equal(rgb.begin(), rgb.begin() + std::ptrdiff_t(exact), image.rgb.begin()));
    int most = 0;
    for (std::size_t i = exact; i < rgb.size(); ++i) {
        most = std::max(most, std::abs(int(rgb[i]) - int(image.rgb[i])));
    }
    EXPECT_LT(most, 80) << "of colours spread over the whole cube: 128 balls cover it";
}

TEST(Png, HoldsThePictureByteForByte) {
    Image image{.width = 37, .height = 11, .rgb = {}};
    std::mt19937 random{5};
    for (int i = 0; i < image.width * image.height * 3; ++i) {
        image.rgb.push_back(std::uint8_t(random()));
    }
    const auto bytes = encode_png(image);

    png_image read{};
    read.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_memory(&read, bytes.data(), bytes.size()), 0);
    EXPECT_EQ(read.format, png_uint_32(PNG_FORMAT_RGB));
    EXPECT_EQ(read.width, 37U);
    EXPECT_EQ(read.height, 11U);
    std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(read));
    ASSERT_NE(png_image_finish_read(&read, nullptr, rgb.data(), 0, nullptr), 0);
    EXPECT_EQ(rgb, image.rgb);
}

TEST(Png, IsTheSameFileHoweverManyRowsComeAtATime) {
    Image image{.width = 300, .height = 210, .rgb = {}};
    std::mt19937 random{6};
    for (int i = 0; i < image.width * image.height * 3; ++i) {
        image.rgb.push_back(std::uint8_t(random()));
    }
    const auto whole = encode_png(image);
    for (const std::size_t rows : {1, 7, 210}) {
        std::vector<std::uint8_t> bytes;
        PngWriter writer{{image.width, image.height}, [&](std::string_view more) {
                             bytes.insert(bytes.end(), more.begin(), more.end());
                         }};
        const auto step = rows * 300 * 3;
        for (std::size_t at = 0; at < image.rgb.size(); at += step) {
            writer.add(std::span{image.rgb}.subspan(at, step));
        }
        writer.finish();
        EXPECT_TRUE(bytes == whole) << rows;
    }
}

} // namespace macadam::testing
