// The end of a background within a map.

#include "render/background/background_fade.hpp"

#include "render/background/background_painter.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cstdint>
#include <vector>

namespace macadam {
namespace {

using ::testing::Each;
using ::testing::Eq;

constexpr PixelBox map{0, 0, 200, 100};
constexpr PixelBox roads{50, 20, 150, 80};
constexpr double width_px = 20;
constexpr std::uint32_t ground = 0xffffff;

std::vector<BackgroundShape> water(const PixelBox& box) {
    return {{BackgroundKind::water,
             box,
             {{{box.left, box.top},
               {box.right, box.top},
               {box.right, box.bottom},
               {box.left, box.bottom}}}}};
}

/// Returns the colours of a row of the map at half its height.
std::vector<std::uint32_t> row_of(const PixelBox& sea) {
    const auto shapes = water(sea);
    const PicturePart part{0, 50, 200, 1};
    const auto rgba = painted_background(shapes,
                                         MapStyle::Theme::light,
                                         ground,
                                         background_fade(shapes, roads, map, width_px))(part);
    std::vector<std::uint32_t> colours;
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        colours.push_back(std::uint32_t(rgba[i]) << 16U | std::uint32_t(rgba[i + 1]) << 8U |
                          rgba[i + 2]);
    }
    return colours;
}

TEST(BackgroundFade, HidesTheCutOfASeaThatEndsWithinTheMap) {
    const auto sea = background_colour(BackgroundKind::water, MapStyle::Theme::light);
    const auto row = row_of({10, -50, 190, 150});
    for (int x = 50; x < 150; ++x) {
        EXPECT_EQ(row[std::size_t(x)], sea) << x;
    }
    for (const std::size_t x : {9, 10, 29, 170, 189, 190}) {
        EXPECT_EQ(row[x], ground) << x;
    }
    for (std::size_t x = 150; x < 170; ++x) {
        EXPECT_LE(row[x] >> 16U, row[x + 1] >> 16U) << x;
        EXPECT_LE((row[x + 1] >> 16U) - (row[x] >> 16U), 8) << x << ": an edge";
        EXPECT_EQ(row[x], row[199 - x]) << x;
    }
}

TEST(BackgroundFade, EndsWhereTheBackgroundDoesIfThatIsNear) {
    const auto fade = background_fade(water({10, -50, 156, 150}), roads, map, width_px);
    ASSERT_TRUE(fade);
    EXPECT_EQ(fade->right, std::pair(150.0, 156.0));
    EXPECT_EQ(fade->left, std::pair(-50.0, -30.0));
}

TEST(BackgroundFade, LeavesABackgroundThatReachesTheEdgesOfTheMap) {
    const auto sea = background_colour(BackgroundKind::water, MapStyle::Theme::light);
    EXPECT_THAT(row_of({-10, -50, 210, 150}), Each(Eq(sea)));
    EXPECT_FALSE(background_fade({}, roads, map, width_px));
}

TEST(BackgroundFade, TakesTheSidesAlongThatReachTheEdgeIfTheyHaveRoom) {
    const auto fade = background_fade(water({-10, -50, 190, 150}), roads, map, width_px);
    ASSERT_TRUE(fade);
    EXPECT_EQ(fade->share(40, 50), fade->share(160, 50));
    EXPECT_EQ(fade->share(100, 1), 1) << "20 px are no room for 20 px and ground beyond them";
}

} // namespace
} // namespace macadam
