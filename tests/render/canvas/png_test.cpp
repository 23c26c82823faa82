#include "render/canvas/png.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <random>

namespace macadam::testing {

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
