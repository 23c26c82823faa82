// A picture drawn some rows at a time is the one drawn whole.

#include "estimator/common/error.hpp"
#include "render/map/map_plan.hpp"
#include "render/roads/road_painter.hpp"
#include "render/roads/road_polylines.hpp"
#include "render/roads/stroke_painter.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <random>

namespace macadam::testing {
namespace {

constexpr std::array names{"Langenloiser Straße", "Am Kai", "", "Οδός Αθηνών"};

/// Roads of every look and rank, winding, long and short, with names.
MapScene town() {
    std::mt19937 random{3};
    const auto within = [&](double low, double high) {
        return low + (high - low) * double(random()) / double(std::mt19937::max());
    };
    MapScene scene{.box = {16, 48, 16.02, 48.012},
                   .lines = {},
                   .title = "Roads of a town",
                   .subtitle = "May to June",
                   .attribution = "© contributors",
                   .class_km = {1, 2, 3}};
    for (int i = 0; i < 60; ++i) {
        MapLine road;
        GeoPoint at{within(48, 48.012), within(16, 16.02)};
        double heading_rad = within(0, 6.28);
        const double step = i % 7 == 0 ? 0.02 : 0.0008;
        for (int piece = 0; piece < 8; ++piece) {
            road.line.push_back(at);
            heading_rad += within(-0.5, 0.5);
            at.lat_deg += 0.7 * step * std::sin(heading_rad);
            at.lon_deg += step * std::cos(heading_rad);
        }
        road.iri_class = i % 4 - 1;
        road.rank = i % 6;
        road.certain = i % 3 != 0;
        road.few_passes = i % 11 == 0;
        road.name = names[std::size_t(i) % names.size()];
        scene.lines.push_back(road);
        if (i % 2 == 0) {
            scene.lines.back().both_ways = true;
            auto back = scene.lines.back();
            std::ranges::reverse(back.line);
            back.forward = false;
            scene.lines.push_back(back);
        }
    }
    return scene;
}

std::vector<std::uint8_t>
drawn(const MapScene& scene, const MapStyle& style, const PictureSize& size) {
    std::vector<std::uint8_t> rgb;
    MapPlan{scene, style, size}.draw([&](std::span<const std::uint8_t> rows) {
        rgb.insert(rgb.end(), rows.begin(), rows.end());
    });
    return rgb;
}

std::vector<std::uint8_t> columns_of(const Image& image, int first, int count) {
    std::vector<std::uint8_t> rgb;
    for (int y = 0; y < image.height; ++y) {
        const auto* row =
            image.rgb.data() + (std::size_t(y) * std::size_t(image.width) + std::size_t(first)) * 3;
        rgb.insert(rgb.end(), row, row + std::size_t(count) * 3);
    }
    return rgb;
}

/// Strands on places of 1/1024 px, which can be moved by whole pixels exactly.
std::vector<Polyline> strands_around(double middle_px, double height_px) {
    std::mt19937 random{8};
    const auto within = [&](double low, double high) {
        return std::round((low + (high - low) * double(random()) / double(std::mt19937::max())) *
                          1024) /
               1024;
    };
    std::vector<Polyline> strands;
    for (int i = 0; i < 40; ++i) {
        Polyline strand{.points = {}, .looks = {}, .rank = i % 6};
        const double reach_px = i % 5 == 0 ? 5000 : 150;
        for (int j = 0; j < 6; ++j) {
            strand.points.push_back(
                {middle_px + within(-reach_px, reach_px), within(0, height_px)});
        }
        for (int j = 0; j < 5; ++j) {
            strand.looks.push_back(i % 4 == 0 ? unmeasured_look
                                              : look_of((i + j / 2) % 3, i % 3 == 0));
        }
        strands.push_back(strand);
    }
    return strands;
}

} // namespace

TEST(PictureBands, AreThePictureDrawnWholeInEveryTheme) {
    const auto scene = town();
    for (const auto theme :
         {MapStyle::Theme::light, MapStyle::Theme::dark, MapStyle::Theme::print}) {
        const MapStyle style{.theme = theme};
        const auto whole = drawn(scene, style, {700, 520, 520});
        EXPECT_TRUE(render_map(scene, style, {700, 520}).rgb == whole);
        for (const int band_px : {23, 64, 300, 519}) {
            EXPECT_TRUE(drawn(scene, style, {700, 520, band_px}) == whole)
                << band_px << " rows, theme " << int(theme);
        }
    }
}

TEST(PictureBands, AreThePictureDrawnWholeRowByRow) {
    const auto scene = town();
    EXPECT_TRUE(drawn(scene, {}, {260, 300, 1}) == drawn(scene, {}, {260, 300, 300}));
}

TEST(PictureBands, AreThePictureDrawnWholeWhereItIsLarge) {
    const auto scene = town();
    const auto whole = drawn(scene, {}, {3000, 2100, 2100});
    EXPECT_TRUE(drawn(scene, {}, {3000, 2100, 512}) == whole);
}

TEST(PictureBands, PaintEachColumnAsIfItWereTheOnlyOne) {
    // The second window of a wide sheet begins inside, and the sheet is compared across its edge.
    constexpr int width_px = 600;
    constexpr int height_px = 120;
    const auto from_px = max_stroke_window_px - width_px / 2;
    const auto strands = strands_around(max_stroke_window_px, height_px);
    auto shifted = strands;
    for (auto& strand : shifted) {
        for (auto& point : strand.points) {
            point.x -= from_px;
        }
    }
    const auto colours = palette(MapStyle::Theme::light);
    const auto classes = ramp_colours("rdylbu", 3);
    const LineWidths widths{.core_px = 6, .casing_px = 2};
    const int whole_px = max_stroke_window_px + 1000;
    const auto wide = painted_roads({whole_px, height_px, {0, 0, double(whole_px), height_px}},
                                    strands,
                                    widths,
                                    colours,
                                    classes);
    const auto alone = painted_roads(
        {width_px, height_px, {0, 0, width_px, height_px}}, shifted, widths, colours, classes);
    EXPECT_TRUE(columns_of(wide, from_px, width_px) == alone.rgb);
}

TEST(PictureBands, AreToldAsTheyAreDrawn) {
    std::vector<std::size_t> told;
    std::vector<std::size_t> taken;
    Progress progress;
    progress.report = [&](std::size_t done, std::size_t whole) {
        told.push_back(done);
        EXPECT_EQ(whole, 400U);
    };
    MapPlan{town(), {}, {300, 400, 150}}.draw([&](auto rows) { taken.push_back(rows.size()); },
                                              progress);
    EXPECT_THAT(told, ::testing::ElementsAre(150, 300, 400));
    EXPECT_THAT(taken, ::testing::ElementsAre(150 * 900, 150 * 900, 100 * 900));
}

TEST(PictureBands, EndWhereTheyAreNoLongerWanted) {
    std::stop_source source;
    Progress progress;
    progress.stop = source.get_token();
    int taken = 0;
    MapPlan plan{town(), {}, {300, 400, 150}};
    EXPECT_THAT(
        [&] {
            plan.draw(
                [&](auto) {
                    ++taken;
                    source.request_stop();
                },
                progress);
        },
        ::testing::ThrowsMessage<InputError>("stopped before the picture was complete"));
    EXPECT_EQ(taken, 1);
}

} // namespace macadam::testing
