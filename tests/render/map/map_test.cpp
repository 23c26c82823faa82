#include "render/map/map_plan.hpp"

#include "estimator/common/error.hpp"
#include "render/map/sheet/map_surround.hpp"
#include "render/scene/colour.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace macadam::testing {
namespace {

constexpr std::uint32_t good = 0x2c7bb6;
constexpr std::uint32_t poor = 0xd7191c;

/// A road through places in metres from the middle of the map, east and north.
MapLine road(const std::vector<PointEn>& places, int iri_class) {
    MapLine line;
    for (const auto& [east_m, north_m] : places) {
        line.line.push_back({48 + north_m / 111200, 16 + east_m / 74600});
    }
    line.iri_class = iri_class;
    return line;
}

MapScene scene(std::vector<MapLine> lines, double half_side_m) {
    return {.box = grown({16, 48, 16, 48}, half_side_m),
            .lines = std::move(lines),
            .title = "Roads",
            .subtitle = {},
            .attribution = {},
            .class_km = {}};
}

/// A road due east and the same due west.
MapScene both_ways(int east_class, int west_class, double half_side_m) {
    auto east = road({{-half_side_m, 0}, {half_side_m, 0}}, east_class);
    auto west = road({{half_side_m, 0}, {-half_side_m, 0}}, west_class);
    east.both_ways = west.both_ways = true;
    west.forward = false;
    return scene({east, west}, half_side_m);
}

std::uint32_t pixel(const Image& image, int x, int y) {
    const auto* rgb = image.rgb.data() + (std::size_t(y) * image.width + std::size_t(x)) * 3;
    return std::uint32_t(rgb[0]) << 16 | std::uint32_t(rgb[1]) << 8 | rgb[2];
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

int red_over_blue(std::uint32_t rgb) {
    return int(rgb >> 16 & 255U) - int(rgb & 255U);
}

/// Of the middle column.
std::pair<int, int> range_of_red_over_blue(const Image& image) {
    std::pair range{255, -255};
    for (int y = 0; y < image.height; ++y) {
        const int value = red_over_blue(pixel(image, image.width / 2, y));
        range = {std::min(range.first, value), std::max(range.second, value)};
    }
    return range;
}

std::size_t count_of(const Image& image, const PixelBox& box, std::uint32_t rgb) {
    std::size_t count = 0;
    for (int y = int(box.top); y < int(box.bottom); ++y) {
        for (int x = int(box.left); x < int(box.right); ++x) {
            count += pixel(image, x, y) == rgb ? 1 : 0;
        }
    }
    return count;
}

MapScene grid(int streets, double half_side_m) {
    std::vector<MapLine> lines;
    for (int i = 0; i < streets; ++i) {
        const double at_m = half_side_m * (2.0 * i / (streets - 1) - 1);
        lines.push_back(road({{-half_side_m, at_m}, {half_side_m, at_m}}, i % 3));
        lines.push_back(road({{at_m, -half_side_m}, {at_m, half_side_m}}, (i + 1) % 3));
    }
    return scene(lines, half_side_m);
}

} // namespace

TEST(Map, DrivesOnTheRight) {
    const auto image = render_map(both_ways(0, 2, 400), {}, {512, 512});
    const auto eastbound = rows_of(image, good);
    const auto westbound = rows_of(image, poor);
    ASSERT_FALSE(eastbound.empty());
    ASSERT_FALSE(westbound.empty());
    EXPECT_GT(eastbound.front(), westbound.back()); // right of east is south, farther down
}

TEST(Map, DrivesOnTheLeftWhereTheyDo) {
    const auto image = render_map(both_ways(0, 2, 400), {.left_hand_traffic = true}, {512, 512});
    const auto eastbound = rows_of(image, good);
    const auto westbound = rows_of(image, poor);
    ASSERT_FALSE(eastbound.empty());
    ASSERT_FALSE(westbound.empty());
    EXPECT_LT(eastbound.back(), westbound.front());
}

TEST(Map, ShowsTheWorseDirectionWhereThereIsNoRoomForBoth) {
    for (const auto& [east, west] : {std::pair{0, 2}, {2, 0}}) {
        const auto image = render_map(both_ways(east, west, 40000), {}, {512, 512});
        // The line is too thin for its pure colour; red and blue tell the classes apart.
        const auto [bluest, reddest] = range_of_red_over_blue(image);
        EXPECT_GT(reddest, 80);
        EXPECT_GT(bluest, -40);
    }
}

TEST(Map, HasAnEntryInItsLegendForEveryClass) {
    const auto image = render_map(scene({road({{-400, 0}, {400, 0}}, 0)}, 400), {}, {512, 512});
    const PixelBox corner{256, 300, 512, 480};
    const auto colours = ramp_colours("rdylbu", 3);
    ASSERT_EQ(colours.size(), 3U);
    for (const auto rgb : colours) {
        EXPECT_GT(count_of(image, corner, rgb), 20U) << std::hex << rgb;
    }
}

TEST(Map, HasNoLegendWhereThePageHasIt) {
    const auto image =
        render_map(scene({road({{-400, 0}, {400, 0}}, 0)}, 400), {.legend = false}, {512, 512});
    EXPECT_EQ(count_of(image, {0, 0, 512, 512}, poor), 0U);
    EXPECT_GT(count_of(image, {0, 0, 512, 512}, good), 20U);
}

TEST(Map, IsAllMapWhereThePageHasTheWords) {
    auto bare = scene({road({{0, 400}, {0, -400}}, 0)}, 400);
    bare.title.clear();
    bare.scale_bar = false;
    const auto image = render_map(bare, {.legend = false}, {512, 384});
    const auto colours = palette(MapStyle::Theme::light);
    EXPECT_EQ(count_of(image, {0, 0, 512, 384}, colours.page), 0U);
    EXPECT_EQ(count_of(image, {0, 0, 512, 384}, colours.ink), 0U);
}

TEST(Map, PutsTheLegendWhereNoRoadIs) {
    TypeSetter setter;
    auto diagonal = scene({road({{-400, 400}, {400, -400}}, 2)}, 400); // north-west to south-east
    const auto layout = layout_of(diagonal, {800, 800}, setter);
    const auto legend = legend_of(diagonal, {}, *class_table("fhwa"));
    const auto placement = placement_of(diagonal, legend, layout, setter);
    EXPECT_LT(placement.corner.x, 400);
    EXPECT_GT(placement.corner.y, 400);
}

TEST(Map, MakesRoomForTheLegendWhereRoadsAreEverywhere) {
    TypeSetter setter;
    const auto city = grid(12, 800);
    for (const auto& [width_px, height_px] :
         {std::pair{512, 512}, {1200, 600}, {600, 1200}, {256, 256}}) {
        const auto layout = layout_of(city, {width_px, height_px}, setter);
        const auto legend = legend_of(city, {}, *class_table("fhwa"));
        const auto placement = placement_of(city, legend, layout, setter);
        const auto low = to_pixel(placement.frame, {city.box.south_deg, city.box.west_deg});
        const auto high = to_pixel(placement.frame, {city.box.north_deg, city.box.east_deg});
        EXPECT_TRUE(high.x < placement.corner.x || low.y < placement.corner.y)
            << width_px << 'x' << height_px;
        EXPECT_GE(placement.corner.x, 0);
        EXPECT_LE(placement.corner.x + placement.card.width_px, width_px);
    }
}

TEST(Map, ShortensTheLegendOfASmallPictureRatherThanItsRoads) {
    TypeSetter setter;
    auto city = grid(12, 800);
    city.class_km = {1.2, 3.4, 5.6};
    const auto legend = legend_of(city, {}, *class_table("fhwa"));
    const auto lengths = [&](int side_px) {
        const auto layout = layout_of(city, {side_px, side_px}, setter);
        return placement_of(city, legend, layout, setter).card.length_px;
    };
    EXPECT_EQ(lengths(512), 0);
    EXPECT_GT(lengths(1024), 0);
}

TEST(Map, LeavesTheRoadsOfASmallPictureTheirPlace) {
    TypeSetter setter;
    auto city = grid(12, 800);
    city.class_km = {1.2, 3.4, 5.6};
    const auto legend = legend_of(city, {}, *class_table("fhwa"));
    for (const int side_px : {320, 400, 512, 640}) {
        const auto layout = layout_of(city, {side_px, side_px}, setter);
        const auto without = placement_of(city, {}, layout, setter).frame;
        const auto with = placement_of(city, legend, layout, setter).frame;
        EXPECT_GT(with.px_per_rad, 0.6 * without.px_per_rad) << side_px; // more road than legend
    }
}

TEST(Map, KeepsTheValuesInAShortLegend) {
    const auto legend = legend_of(scene({}, 400), {}, *class_table("fhwa"));
    const auto shortest = forms_of(legend).back();
    EXPECT_EQ(shortest.title, legend.title);
    EXPECT_EQ(shortest.entries[1].name, "1.50 – 2.68");
    EXPECT_EQ(shortest.entries[1].rgb, legend.entries[1].rgb);
}

TEST(Map, KeepsLongTitlesOnTheSheet) {
    TypeSetter setter;
    auto wordy = scene({}, 400);
    for (int i = 0; i < 40; ++i) {
        wordy.title += "Straßenzustand ";
        wordy.attribution += "© contributors ";
    }
    const auto layout = layout_of(wordy, {512, 512}, setter);
    EXPECT_GT(layout.map.height(), 128);
    for (const auto& text : layout.texts) {
        EXPECT_GE(text.at.x, 0) << text.text;
        EXPECT_LE(text.at.x + setter.width_px(text.text, text.look), 512) << text.text;
        EXPECT_LE(text.at.y, 512) << text.text;
    }
}

TEST(Map, NamesTheValuesOfItsClasses) {
    const auto empty = scene({}, 400);
    const auto metric = legend_of(empty, {}, *class_table("fhwa"));
    EXPECT_EQ(metric.entries[0].range, "below 1.50");
    EXPECT_EQ(metric.entries[1].range, "1.50 – 2.68");
    EXPECT_EQ(metric.entries[2].range, "above 2.68");
    const auto inches = legend_of(empty, {.in_per_mi = true}, *class_table("fhwa"));
    EXPECT_EQ(inches.entries[0].range, "below 95");
    EXPECT_EQ(inches.entries[1].range, "95 – 170");
    const auto five = legend_of(empty, {}, *class_table("five"));
    EXPECT_EQ(five.entries[0].range, "up to 1.5");
}

TEST(Map, ExplainsUnmeasuredAndUncertainRoadsWhereThereAreAny) {
    auto lines = std::vector{road({{0, 0}, {9, 9}}, 0), road({{0, 0}, {9, -9}}, -1)};
    lines[0].certain = false;
    EXPECT_EQ(legend_of(scene(lines, 400), {}, *class_table("fhwa")).entries.size(), 5U);
    EXPECT_EQ(legend_of(scene({}, 400), {}, *class_table("fhwa")).entries.size(), 3U);
}

TEST(Map, DrawsRoadsWithFewPassesInGreyInsideACasing) {
    auto line = road({{-400, 0}, {400, 0}}, 2);
    line.few_passes = true;
    const auto image = render_map(scene({line}, 400), {.legend = false}, {512, 512});
    const auto colours = palette(MapStyle::Theme::light);
    EXPECT_EQ(count_of(image, {0, 0, 512, 512}, poor), 0U);
    EXPECT_GT(rows_of(image, colours.few_passes).size(), 1U);
    // The casing is too thin for its pure colour, but darker than all else.
    int darkest = 255;
    for (int y = 0; y < 400; ++y) {
        darkest = std::min(darkest, int(pixel(image, 256, y) >> 16));
    }
    EXPECT_LT(darkest, int(colours.few_passes >> 16) - 40);
}

TEST(Map, ShowsAClassBeforeTheGreyOfFewPassesWhereThereIsNoRoomForBoth) {
    auto two = both_ways(0, 2, 40000);
    two.lines[1].few_passes = true;
    const auto image = render_map(two, {.legend = false}, {512, 512});
    const auto [bluest, reddest] = range_of_red_over_blue(image);
    EXPECT_LT(bluest, -40); // good is blue
    EXPECT_LT(reddest, 40);
}

TEST(Map, ExplainsGreyRoadsWhereThereAreAny) {
    auto lines = std::vector{road({{0, 0}, {9, 9}}, 0), road({{0, 0}, {9, -9}}, 1)};
    lines[0].few_passes = true;
    const auto legend = legend_of(scene(lines, 400), {.min_passes = 3}, *class_table("fhwa"));
    ASSERT_EQ(legend.entries.size(), 4U);
    EXPECT_EQ(legend.entries[3].name, "Fewer than 3 passes");
    EXPECT_EQ(legend.entries[3].rgb, palette(MapStyle::Theme::light).few_passes);
}

TEST(Map, SpeaksTheWordsOfItsStyle) {
    MapStyle style;
    style.words.title = "Ebenheit";
    style.words.below = "unter {}";
    style.words.above = "{} und mehr";
    const auto legend = legend_of(scene({}, 400), style, *class_table("fhwa"));
    EXPECT_EQ(legend.title, "Ebenheit");
    EXPECT_EQ(legend.entries[0].range, "unter 1.50");
    EXPECT_EQ(legend.entries[2].range, "2.68 und mehr");
}

TEST(Map, DrawsLinesAsWideAsItsStyleWantsThem) {
    const auto sheet = scene({road({{-400, 0}, {400, 0}}, 2)}, 400);
    const auto usual = render_map(sheet, {.legend = false}, {512, 512});
    const auto wide = render_map(sheet, {.lines = {.width = 2}, .legend = false}, {512, 512});
    EXPECT_NEAR(double(rows_of(wide, poor).size()), 2.0 * double(rows_of(usual, poor).size()), 2);
}

TEST(Map, WritesTheNamesOfItsRoadsUnlessTold) {
    auto line = road({{-400, 0}, {400, 0}}, 2);
    line.name = "Langenloiser Straße";
    const auto sheet = scene({line}, 400);
    const auto ink = palette(MapStyle::Theme::light).ink;
    const PixelBox above{0, 400, 1024, 600};
    EXPECT_GT(count_of(render_map(sheet, {.legend = false}, {1024, 1024}), above, ink), 0U);
    EXPECT_EQ(
        count_of(render_map(sheet, {.labels = false, .legend = false}, {1024, 1024}), above, ink),
        0U);
}

TEST(Map, IsTheSameByteForByteEachTime) {
    const auto city = grid(9, 2000);
    const auto once = render_map(city, {}, {700, 400}).rgb;
    for (const auto* threads : {"0", "1", "2"}) {
        setenv("LP_NUM_THREADS", threads, 1); // of OSMesa's rasteriser
        EXPECT_TRUE(render_map(city, {}, {700, 400}).rgb == once) << threads;
    }
    unsetenv("LP_NUM_THREADS");
}

TEST(Map, DrawsRoadsWithoutALength) {
    const auto point = road({{0, 0}}, 2);
    const auto twice = road({{0, 0}, {0, 0}}, 2);
    auto lost = road({{0, 0}, {10, 0}}, 2);
    lost.line[1].lat_deg = std::numeric_limits<double>::quiet_NaN();
    const auto bare = render_map(scene({}, 400), {}, {300, 300}).rgb;
    EXPECT_TRUE(render_map(scene({road({}, 2), point, twice, lost}, 400), {}, {300, 300}).rgb ==
                bare);
}

TEST(Map, IsDrawnInEveryThemeOnItsOwnGround) {
    for (const auto theme :
         {MapStyle::Theme::light, MapStyle::Theme::dark, MapStyle::Theme::print}) {
        const auto image = render_map(scene({}, 400), {.theme = theme}, {300, 300});
        EXPECT_EQ(pixel(image, 10, 150), palette(theme).ground);
    }
}

TEST(Map, RefusesPicturesThatAreTooSmallOrTooLarge) {
    EXPECT_THAT(
        [] {
            render_map(scene({}, 400), {}, {0, 512});
        },
        ::testing::ThrowsMessage<InputError>(
            "picture size '0x512', expected sides of 256 to 32768 px"));
    EXPECT_THAT(
        [] {
            render_map(scene({}, 400), {}, {512, 32769});
        },
        ::testing::ThrowsMessage<InputError>(
            "picture size '512x32769', expected sides of 256 to 32768 px"));
}

TEST(Map, RefusesAnEmptyBox) {
    EXPECT_THAT(
        [] {
            render_map({}, {}, {512, 512});
        },
        ::testing::ThrowsMessage<InputError>(
            "the box of the map is empty, expected west <= east and south <= north"));
}

TEST(Map, RefusesAnUnknownRamp) {
    EXPECT_THAT(
        [] {
            render_map(scene({}, 400), {.ramp = "jet"}, {512, 512});
        },
        ::testing::ThrowsMessage<InputError>(
            "unknown colour ramp 'jet', expected one of rdylbu, cividis, viridis"));
}

TEST(Map, RefusesAClassThatIsNotInTheTable) {
    EXPECT_THAT(
        [] {
            render_map(scene({road({{0, 0}, {9, 9}}, 3)}, 400), {}, {512, 512});
        },
        ::testing::ThrowsMessage<InputError>(
            "a line of class '3', expected -1 to 2 as in table 'fhwa'"));
}

} // namespace macadam::testing
