#include "golden.hpp"

#include "estimator/common/error.hpp"
#include "render/gl/gl_context.hpp"
#include "render/gl/gl_library.hpp"
#include "support/program/places.hpp"

#include <GL/gl.h>
#include <gmock/gmock.h>
#include <png.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

namespace macadam::testing {
namespace {

/// Between OSMesa and EGL, which may be of different versions of Mesa.
constexpr int max_library_levels = 2;

} // namespace

std::string mesa() {
    std::vector<std::uint8_t> rgba(16 * 16 * 4);
    const GlContext context{rgba, 16, 16};
    const auto* const version = context.entry<decltype(&glGetString)>("glGetString")(GL_VERSION);
    return reinterpret_cast<const char*>(version); // NOLINT(*-reinterpret-cast)
}

Image golden(const std::string& name) {
    const auto file = std::filesystem::path{source_folder()} / "tests/data/golden" / name;
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

void expect_same_by_both_libraries(const std::string& name, const std::function<Image()>& draw) {
    const auto drawn_with = [&](const char* library) {
        setenv("MACADAM_OPENGL", library, 1);
        const auto unset = [](const char* variable) { unsetenv(variable); };
        const std::unique_ptr<const char, decltype(unset)> until{"MACADAM_OPENGL", unset};
        return draw();
    };
    const auto by_egl = drawn_with("egl");
    if (has_osmesa()) {
        EXPECT_LE(max_difference(drawn_with("osmesa"), by_egl), max_library_levels) << name;
        return;
    }
    try {
        drawn_with("osmesa");
        ADD_FAILURE() << name << ": drawn by an OSMesa that cannot be opened";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("libOSMesa.so.8"));
    }
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
