#include "render/tiles/tile_painter.hpp"

#include "estimator/common/error.hpp"
#include "render/roads/line_widths.hpp"
#include "render/scene/colour.hpp"
#include "tile_scene.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace macadam::testing {
namespace {

constexpr std::uint32_t good = 0x2c7bb6;
constexpr std::uint32_t poor = 0xd7191c;
const Palette light = palette(MapStyle::Theme::light);

TileId tile_at(int zoom) {
    const std::uint32_t across = 1U << unsigned(zoom);
    return {std::uint8_t(zoom), across / 2 + across / 23, across / 3 + across / 57};
}

std::uint32_t pixel(const Image& image, int x, int y) {
    const auto* rgb = image.rgb.data() + (std::size_t(y) * image.width + std::size_t(x)) * 3;
    return std::uint32_t(rgb[0]) << 16 | std::uint32_t(rgb[1]) << 8 | rgb[2];
}

/// Pixels of the tiles, drawn one by one, that are not those of the large picture.
std::size_t differing_pixels(const TileId& first,
                             int tile_px,
                             int across,
                             const std::vector<MapLine>& lines,
                             const MapStyle& style = {}) {
    TilePainter large{{style, tile_px, across}};
    TilePainter small{{style, tile_px, 1}};
    const auto whole = large.draw(first, lines);
    std::size_t count = 0;
    for (int i = 0; i < across * across; ++i) {
        const int left = i % across;
        const int top = i / across;
        const auto tile = small.draw(
            {first.zoom, first.x + std::uint32_t(left), first.y + std::uint32_t(top)}, lines);
        for (int k = 0; k < tile_px * tile_px; ++k) {
            const int x = k % tile_px;
            const int y = k / tile_px;
            count += pixel(tile, x, y) != pixel(whole, left * tile_px + x, top * tile_px + y);
        }
    }
    return count;
}

/// A road from the west to the east through the middle of a tile, and the same back.
std::vector<MapLine> there_and_back(const WorldWindow& window, int east_class, int west_class) {
    const double half_px = window.side_px / 2.0 + 0.5; // the middle of a row
    const PointEn west{-50, half_px};
    const PointEn east{window.side_px + 50.0, half_px};
    std::vector lines{line_at(window, {west, east}, east_class),
                      line_at(window, {east, west}, west_class)};
    lines[0].both_ways = lines[1].both_ways = true;
    lines[1].forward = false;
    return lines;
}

/// Rows of a colour in the middle column.
std::vector<int> rows_of(const Image& image, std::uint32_t rgb) {
    std::vector<int> rows;
    for (int y = 0; y < image.height; ++y) {
        if (pixel(image, image.width / 2, y) == rgb) {
            rows.push_back(y);
        }
    }
    return rows;
}

Image drawn(int zoom, std::vector<MapLine> (*make)(const WorldWindow&), MapStyle style = {}) {
    TilePainter painter{{std::move(style), 256, 1}};
    const auto tile = tile_at(zoom);
    return painter.draw(tile, make(window_of(tile, 256, 1)));
}

} // namespace

TEST(TilePainter, DrawsTilesThatAreThePartsOfOneLargePicture) {
    for (const int zoom : {9, 12, 13, 16, 22}) {
        const auto first = tile_at(zoom);
        EXPECT_EQ(differing_pixels(first, 64, 8, town_in(window_of(first, 64, 8), 60)), 0U) << zoom;
    }
}

TEST(TilePainter, DrawsTilesOf512PixelsThatFitToo) {
    const auto first = tile_at(14);
    EXPECT_EQ(differing_pixels(first, 512, 2, town_in(window_of(first, 512, 2), 90)), 0U);
}

TEST(TilePainter, FitsTilesInEveryStyle) {
    const auto first = tile_at(15);
    const auto town = town_in(window_of(first, 128, 3), 50);
    EXPECT_EQ(differing_pixels(
                  first, 128, 3, town, {.theme = MapStyle::Theme::dark, .left_hand_traffic = true}),
              0U);
}

TEST(TilePainter, FitsTilesAroundALineThroughTheirCorners) {
    const auto first = tile_at(15);
    const auto window = window_of(first, 128, 4);
    const auto diagonal = line_at(window, {{-3000, -3000}, {0, 0}, {128, 128}, {4000, 4000}}, 2);
    const auto round_the_world =
        line_at(window, {{-4e6, 190}, {4e6, 320}}, 1); // some 30,000 pieces, of which 6 are near
    EXPECT_EQ(differing_pixels(first, 128, 4, {diagonal, round_the_world}), 0U);
}

TEST(TilePainter, DrawsNamesThatAreWholeAcrossTheEdgesOfTiles) {
    const auto first = tile_at(15);
    const TileId corner{first.zoom, first.x / 8 * 8, first.y / 8 * 8}; // of a cell of labels
    auto lines = town_in(window_of(corner, 64, 8), 60);
    for (auto& line : lines) {
        line.name = "Hauptstraße";
    }
    auto nameless = lines;
    for (auto& line : nameless) {
        line.name.clear();
    }
    TilePainter painter{{{}, 64, 8}};
    EXPECT_FALSE(painter.draw(corner, lines).rgb == painter.draw(corner, nameless).rgb);
    EXPECT_EQ(differing_pixels(corner, 64, 8, lines), 0U);
}

TEST(TilePainter, LeavesNamesOutWhereTheStyleDoes) {
    const auto tile = tile_at(15);
    auto lines = town_in(window_of(tile, 512, 1), 60);
    TilePainter painter{{{.labels = false}, 512, 1}};
    const auto nameless = painter.draw(tile, lines).rgb;
    for (auto& line : lines) {
        line.name = "Hauptstraße";
    }
    EXPECT_TRUE(painter.draw(tile, lines).rgb == nameless);
}

TEST(TilePainter, NeedsOnlyTheLinesNearTheTile) {
    const auto first = tile_at(15);
    const auto all = town_in(window_of(first, 128, 4), 60);
    TilePainter painter{{{}, 128, 1}};
    // A piece is 20 px long, so the lines that end at one that reaches the tile are within 60 px.
    std::vector<MapLine> near;
    const auto box = tile_box(first, 60.0 / 128);
    for (const auto& line : all) {
        const auto low = std::ranges::min(line.line, {}, &GeoPoint::lon_deg);
        const auto high = std::ranges::max(line.line, {}, &GeoPoint::lon_deg);
        const auto south = std::ranges::min(line.line, {}, &GeoPoint::lat_deg);
        const auto north = std::ranges::max(line.line, {}, &GeoPoint::lat_deg);
        if (low.lon_deg <= box.east_deg && high.lon_deg >= box.west_deg &&
            south.lat_deg <= box.north_deg && north.lat_deg >= box.south_deg) {
            near.push_back(line);
        }
    }
    ASSERT_LT(near.size(), all.size() / 2);
    EXPECT_TRUE(painter.draw(first, near).rgb == painter.draw(first, all).rgb);
}

TEST(TilePainter, DrawsTheSameWhateverItDrewBefore) {
    const auto first = tile_at(15);
    const auto window = window_of(first, 256, 1);
    TilePainter painter{{{}, 256, 1}};
    const auto once = painter.draw(first, town_in(window, 60)).rgb;
    painter.draw(first, there_and_back(window, 0, 2));
    EXPECT_TRUE(painter.draw(first, town_in(window, 60)).rgb == once);
}

TEST(TilePainter, KeepsEachDirectionToItsSideFromZoom13On) {
    const auto road = [](const WorldWindow& window) { return there_and_back(window, 0, 2); };
    const auto image = drawn(13, road);
    ASSERT_FALSE(rows_of(image, good).empty());
    ASSERT_FALSE(rows_of(image, poor).empty());
    // Right of east is south, farther down.
    EXPECT_GT(rows_of(image, good).front(), rows_of(image, poor).back());
    const auto left = drawn(13, road, {.left_hand_traffic = true});
    EXPECT_LT(rows_of(left, good).back(), rows_of(left, poor).front());
}

TEST(TilePainter, TakesTilesOf512PixelsForTheZoomAtWhichTheyAreDrawn) {
    const auto tile = tile_at(12);
    TilePainter painter{{{}, 512, 1}};
    const auto image = painter.draw(tile, there_and_back(window_of(tile, 512, 1), 0, 2));
    EXPECT_FALSE(rows_of(image, poor).empty());
    EXPECT_FALSE(rows_of(image, good).empty());
}

TEST(TilePainter, ShowsTheWorseDirectionBelowZoom13) {
    const auto there_good = [](const WorldWindow& window) { return there_and_back(window, 0, 2); };
    const auto back_good = [](const WorldWindow& window) { return there_and_back(window, 2, 0); };
    for (const auto& image : {drawn(12, there_good), drawn(12, back_good)}) {
        EXPECT_FALSE(rows_of(image, poor).empty());
        EXPECT_TRUE(rows_of(image, good).empty());
    }
}

TEST(TilePainter, WidensLinesFrom1PixelAtZoom10To6AtZoom16) {
    EXPECT_DOUBLE_EQ(tile_widths(10).core_px, 1);
    EXPECT_DOUBLE_EQ(tile_widths(16).core_px, 6);
    // What a zoom adds grows by half with each zoom.
    const auto growth = [](int zoom) {
        return tile_widths(zoom + 1).core_px - tile_widths(zoom).core_px;
    };
    EXPECT_NEAR(growth(12) / growth(11), 1.5, 1e-12);
    const auto image = drawn(16, [](const WorldWindow& window) {
        return std::vector{line_at(window, {{-50, 128}, {300, 128}}, 2)};
    });
    EXPECT_THAT(rows_of(image, poor), ::testing::ElementsAre(125, 126, 127, 128, 129, 130));
}

TEST(TilePainter, DrawsAnUncertainRoadWithANarrowerCore) {
    const auto image = drawn(16, [](const WorldWindow& window) {
        std::vector lines{line_at(window, {{-50, 128}, {300, 128}}, 2)};
        lines[0].certain = false;
        return lines;
    });
    EXPECT_THAT(rows_of(image, poor), ::testing::ElementsAre(127, 128));
    EXPECT_EQ(pixel(image, 128, 125), light.casing);
}

TEST(TilePainter, DrawsRoadsWithFewPassesInGreyInACasing) {
    const auto image = drawn(16, [](const WorldWindow& window) {
        std::vector lines{line_at(window, {{-50, 128}, {300, 128}}, 2)};
        lines[0].few_passes = true;
        return lines;
    });
    EXPECT_THAT(rows_of(image, light.few_passes),
                ::testing::ElementsAre(125, 126, 127, 128, 129, 130));
    EXPECT_EQ(pixel(image, 128, 124), light.casing);
}

TEST(TilePainter, LaysUnmeasuredRoadsBelowAllOthers) {
    const auto image = drawn(16, [](const WorldWindow& window) {
        return std::vector{line_at(window, {{-50, 128}, {300, 128}}, 2),
                           line_at(window, {{128, -50}, {128, 300}}, -1, 0)};
    });
    EXPECT_EQ(pixel(image, 128, 128), poor);
    EXPECT_EQ(pixel(image, 128, 60), light.unmeasured);
    EXPECT_EQ(pixel(image, 60, 60), light.ground);
}

TEST(TilePainter, DrawsNothingOfLinesWithoutALength) {
    const auto tile = tile_at(15);
    const auto window = window_of(tile, 256, 1);
    auto one_place = line_at(window, {{100, 100}}, 1);
    auto twice = line_at(window, {{100, 100}, {100, 100}}, 1);
    TilePainter painter{{{}, 256, 1}};
    EXPECT_TRUE(painter.draw(tile, std::vector{one_place, twice}).rgb ==
                painter.draw(tile, {}).rgb);
}

TEST(TilePainter, TellsHowFarALineReaches) {
    const auto tile = tile_at(16);
    const auto window = window_of(tile, 256, 1);
    TilePainter painter{{{}, 256, 1}};
    const double out_px = painter.reach_px(16);
    auto lines = std::vector{line_at(window, {{-out_px, -50}, {-out_px, 300}}, 1, 0),
                             line_at(window, {{-out_px, 300}, {-out_px, -50}}, 1, 0)};
    lines[0].both_ways = lines[1].both_ways = true;
    lines[1].forward = false;
    EXPECT_TRUE(painter.draw(tile, lines).rgb == painter.draw(tile, {}).rgb);
}

TEST(TilePainter, RefusesSizesThatItCannotDraw) {
    EXPECT_THAT(
        [] {
            TilePainter({{}, 32, 1});
        },
        ::testing::ThrowsMessage<InputError>("tile size '32', expected 64 to 4096 px"));
    EXPECT_THAT(
        [] {
            TilePainter({{}, 256, 33});
        },
        ::testing::ThrowsMessage<InputError>("'33' tiles of 256 px across, expected 1 to 32"));
}

TEST(TilePainter, RefusesAClassThatIsNotInTheTable) {
    const auto tile = tile_at(15);
    TilePainter painter{{{}, 256, 1}};
    EXPECT_THAT(
        [&] {
            painter.draw(tile, std::vector{line_at(window_of(tile, 256, 1), {{0, 0}, {9, 9}}, 3)});
        },
        ::testing::ThrowsMessage<InputError>(
            "a line of class '3', expected -1 to 2 as in table 'fhwa'"));
}

} // namespace macadam::testing
