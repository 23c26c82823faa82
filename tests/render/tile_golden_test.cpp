// Pictures that were looked at and found good, kept in tests/data/golden. They are held byte for
// byte: with one Mesa, pictures are the same on every machine.

#include "render/gl_context.hpp"
#include "render/tile_painter.hpp"
#include "render/tile_scene.hpp"

#include <GL/gl.h>
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace macadam::testing {
namespace {

constexpr const char* golden_mesa = "Mesa 22.3.6"; // Debian 12's, which drew them
constexpr int other_mesa_levels = 2; // what another driver of Mesa's, softpipe, was seen to differ

struct Scene {
    std::string name;
    int zoom;
    TileLook look;
    double block_px;
};

const std::array scenes{
    Scene{"streets-light", 16, {{}, 256, 1}, 90},
    Scene{"streets-dark-left-hand",
          15,
          {{.theme = MapStyle::Theme::dark,
            .ramp = "cividis",
            .classes = class_table("five"),
            .left_hand_traffic = true},
           256,
           1},
          60},
    Scene{"dense-town-print", 13, {{.theme = MapStyle::Theme::print}, 128, 2}, 14},
    Scene{"region-light", 11, {{}, 512, 1}, 30},
};

Image drawn(const Scene& scene) {
    TilePainter painter{scene.look};
    const std::uint32_t across = 1U << unsigned(scene.zoom);
    const TileId first{std::uint8_t(scene.zoom), across / 2 + across / 23, across / 3};
    const auto window = window_of(first, scene.look.tile_px, scene.look.across);
    return painter.draw(first, town_in(window, scene.block_px));
}

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

/// So that what was drawn can be looked at, and kept if it is better.
void leave(const std::string& name, const Image& image) {
    if (const char* const folder = std::getenv("MACADAM_LEAVE_PICTURES")) {
        const auto png = encode_png(image);
        std::ofstream{std::filesystem::path{folder} / (name + ".png"), std::ios::binary}.write(
            reinterpret_cast<const char*>(png.data()), // NOLINT(*-reinterpret-cast)
            std::streamsize(png.size()));
    }
}

int most_difference(const Image& a, const Image& b) {
    if (a.rgb.size() != b.rgb.size()) {
        return 256;
    }
    int most = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) {
        most = std::max(most, std::abs(int(a.rgb[i]) - int(b.rgb[i])));
    }
    return most;
}

} // namespace

TEST(TileGolden, TilesAreThoseThatWereFoundGood) {
    const auto version = mesa();
    const bool same_mesa = version.find(golden_mesa) != std::string::npos;
    for (const auto& scene : scenes) {
        const auto image = drawn(scene);
        leave(scene.name, image);
        const auto kept = golden(scene.name);
        EXPECT_LE(most_difference(image, kept), same_mesa ? 0 : other_mesa_levels)
            << "tests/data/golden/" << scene.name << ".png was drawn by " << golden_mesa
            << ", and this is '" << version << "'; another one may differ by " << other_mesa_levels
            << " levels. MACADAM_LEAVE_PICTURES=FOLDER leaves there what was drawn";
    }
}

} // namespace macadam::testing
