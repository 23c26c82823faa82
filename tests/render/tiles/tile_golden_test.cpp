#include "render/map/golden.hpp"
#include "render/tiles/tile_painter.hpp"
#include "tile_scene.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace macadam::testing {
namespace {

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

} // namespace

TEST(TileGolden, TilesAreThoseThatWereFoundGood) {
    const auto version = mesa();
    const bool same_mesa = version.find(golden_mesa) != std::string::npos;
    for (const auto& scene : scenes) {
        const auto image = drawn(scene);
        leave(scene.name, image);
        const auto kept = golden(scene.name);
        EXPECT_LE(max_difference(image, kept), same_mesa ? 0 : other_mesa_levels)
            << "tests/data/golden/" << scene.name << ".png was drawn by " << golden_mesa
            << ", and this is '" << version << "'; another one may differ by " << other_mesa_levels
            << " levels. MACADAM_LEAVE_PICTURES=FOLDER leaves there what was drawn";
    }
}

TEST(TileGolden, OsmesaAndEglDrawTheSameTiles) {
    for (const auto& scene : scenes) {
        expect_same_by_both_libraries(scene.name, [&] { return drawn(scene); });
    }
}

} // namespace macadam::testing
