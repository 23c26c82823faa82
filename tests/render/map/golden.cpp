#include "golden.hpp"

#include "render/gl/gl_context.hpp"

#include <GL/gl.h>
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace macadam::testing {

std::string mesa() {
    std::vector<std::uint8_t> rgba(16 * 16 * 4);
    const GlContext context{rgba, 16, 16};
    const auto* const version = context.entry<decltype(&glGetString)>("glGetString")(GL_VERSION);
    return reinterpret_cast<const char*>(version); // NOLINT(*-reinterpret-cast)
}

Image golden(const std::string& name) {
    const auto file = std::filesystem::path{MACADAM_SOURCE_DIR} / "tests/data/golden" / name;
    png_image read{};
    read.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_file(&read, (file.string() + ".png").c_str()), 0)
        << file << ": " << read.message;
    read.format = PNG_FORMAT_RGB;
    Image image{int(read.width), int(read.height), std::vector<std::uint8_t>(PNG_IMAGE_SIZE(read))};
    EXPECT_NE(png_image_finish_read(&read, nullptr, image.rgb.data(), 0, nullptr), 0);
    return image;
}

void leave(const std::string& name, const Image& image) {
    if (const char* const folder = std::getenv("MACADAM_LEAVE_PICTURES")) {
        const auto png = encode_png(image);
        std::ofstream{std::filesystem::path{folder} / (name + ".png"), std::ios::binary}.write(
            reinterpret_cast<const char*>(png.data()), // NOLINT(*-reinterpret-cast)
            std::streamsize(png.size()));
    }
}

Image drawn_with(const char* library, const std::function<Image()>& draw) {
    setenv("MACADAM_OPENGL", library, 1);
    auto image = draw();
    unsetenv("MACADAM_OPENGL");
    return image;
}

int max_difference(const Image& a, const Image& b) {
    if (a.rgb.size() != b.rgb.size()) {
        return 256;
    }
    int most = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) {
        most = std::max(most, std::abs(int(a.rgb[i]) - int(b.rgb[i])));
    }
    return most;
}

double mean_difference(const Image& a, const Image& b) {
    if (a.rgb.size() != b.rgb.size()) {
        return 256;
    }
    double sum = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) {
        sum += std::abs(int(a.rgb[i]) - int(b.rgb[i]));
    }
    return sum / double(std::max<std::size_t>(1, a.rgb.size()));
}

} // namespace macadam::testing
