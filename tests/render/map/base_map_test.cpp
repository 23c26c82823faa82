// A base map under the roads: what of it is seen, where, and that bands do not show.

#include "mapping/style/base_map.hpp"
#include "render/map/base_map_blend.hpp"
#include "render/map/map_plan.hpp"
#include "render/roads/road_painter.hpp"
#include "render/roads/road_polylines.hpp"
#include "render/scene/colour.hpp"
#include "support/files/files.hpp"
#include "support/program/shell.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

using Pixel = std::array<int, 4>;

/// A base map that is known pixel by pixel.
std::shared_ptr<BaseMap> painted(std::function<Pixel(int x, int y)> colour) {
    auto base = std::make_shared<BaseMap>();
    base->laid_on = [colour = std::move(colour)](const PicturePlane&) -> PaintPart {
        return [colour](const PicturePart& part) {
            std::vector<std::uint8_t> rgba;
            for (int y = part.top_px; y < part.top_px + part.height_px; ++y) {
                for (int x = part.left_px; x < part.left_px + part.width_px; ++x) {
                    for (const int channel : colour(x, y)) {
                        rgba.push_back(std::uint8_t(channel));
                    }
                }
            }
            return rgba;
        };
    };
    return base;
}

/// Each pixel of another colour than those around it.
Pixel patterned(int x, int y) {
    return {x * 7 & 255, y * 11 & 255, (x ^ y) & 255, 255};
}

Pixel at(const Image& image, int x, int y) {
    const auto* const rgb =
        image.rgb.data() + (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * 3;
    return {rgb[0], rgb[1], rgb[2], 255};
}

Pixel colour_of(std::uint32_t rgb) {
    return {int(rgb >> 16 & 255U), int(rgb >> 8 & 255U), int(rgb & 255U), 255};
}

/// A measured road from west to east and one without a measurement from south to north.
MapScene crossing() {
    MapScene scene;
    scene.box = {16, 48, 16.012, 48.006};
    MapLine road;
    road.line = {{48.003, 16.001}, {48.003, 16.011}};
    road.iri_class = 2;
    road.name = "Ring";
    scene.lines.push_back(road);
    MapLine quiet;
    quiet.line = {{48.0005, 16.003}, {48.0055, 16.003}};
    scene.lines.push_back(quiet);
    return scene;
}

MapScene bare_crossing() {
    auto scene = crossing();
    scene.scale_bar = false;
    scene.to_the_edge = true;
    return scene;
}

const MapStyle plain{.labels = false, .legend = false, .base_opacity = 1};

} // namespace

TEST(BaseMap, LiesUnderTheRoadsPixelByPixel) {
    auto scene = bare_crossing();
    const auto without = render_map(scene, plain, {500, 400});
    scene.base = painted(patterned);
    const auto with = render_map(scene, plain, {500, 400});
    const auto ground = colour_of(palette(plain).ground);
    int shown = 0;
    int road = 0;
    for (int y = 0; y < 400; ++y) {
        for (int x = 0; x < 500; ++x) {
            if (at(without, x, y) != ground) {
                ++road;
            } else if (at(with, x, y) == patterned(x, y)) {
                ++shown;
            }
        }
    }
    EXPECT_GT(road, 2000);
    // What is neither is the edge of the road without a measurement.
    EXPECT_GT(shown, 500 * 400 - road - 400 * 8);
    const auto class_colour = colour_of(class_colours(plain, 3)[2]);
    EXPECT_EQ(at(without, 250, 200), class_colour);
    EXPECT_EQ(at(with, 250, 200), class_colour);
}

TEST(BaseMap, IsMixedWithTheGround) {
    auto scene = bare_crossing();
    scene.base = painted([](int x, int) { return Pixel{200, 100, 0, x < 250 ? 255 : 51}; });
    auto style = plain;
    style.base_opacity = 0.25;
    const auto image = render_map(scene, style, {500, 400});
    // Of 0xf4f4f2 and 200, 100, 0: a quarter of the latter, and a quarter of a fifth.
    EXPECT_EQ(at(image, 20, 30), (Pixel{233, 208, 182, 255}));
    EXPECT_EQ(at(image, 400, 30), (Pixel{242, 237, 230, 255}));
}

/// The most that a channel of two pictures differs by.
int max_apart(const Image& a, const Image& b) {
    int most = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) {
        most = std::max(most, std::abs(int(a.rgb[i]) - int(b.rgb[i])));
    }
    return most;
}

TEST(BaseMap, LeavesThePictureAsItIsWhereNothingOfItIsSeen) {
    auto scene = crossing();
    scene.title = "Town";
    // Names have wider halos on a base map.
    const auto without = render_map(scene, {.labels = false}, {500, 400});
    const auto with = [&](const std::shared_ptr<BaseMap>& base, double opacity) {
        scene.base = base;
        return render_map(scene, {.labels = false, .base_opacity = opacity}, {500, 400});
    };
    // Edges in the ground's own colour are blended with it, which rounds.
    EXPECT_LE(max_apart(with(painted(patterned), 0), without), 1);
    EXPECT_LE(max_apart(with(painted([](int, int) { return Pixel{0, 0, 0, 0}; }), 1), without), 1);
    EXPECT_GT(max_apart(with(painted(patterned), 0.1), without), 10);
}

TEST(BaseMap, StaysOnTheMapAndBelowTheLegend) {
    auto scene = crossing();
    scene.title = "Town";
    scene.attribution = "© mappers";
    const auto without = render_map(scene, {}, {700, 500});
    scene.base = painted([](int, int) { return Pixel{255, 0, 255, 255}; });
    const auto with = render_map(scene, {.base_opacity = 1}, {700, 500});
    const auto page = colour_of(palette(MapStyle{}).page);
    int kept = 0;
    for (int y = 0; y < 500; ++y) {
        for (int x = 0; x < 700; ++x) {
            if (at(without, x, y) == page) {
                ++kept;
                EXPECT_EQ(at(with, x, y), page) << x << ", " << y;
            }
        }
    }
    EXPECT_GT(kept, 700 * 80);
}

TEST(BaseMap, LetsQuietRoadsBeSeenByAnEdge) {
    auto scene = bare_crossing();
    const auto grey = palette(plain).unmeasured;
    scene.base = painted([=](int, int) { return colour_of(grey); }); // the road's own colour
    const auto image = render_map(scene, plain, {500, 400});
    std::string across; // far from the measured road: g for grey, e for an edge that is lighter
    for (int x = 60; x < 200; ++x) {
        const char kind = at(image, x, 60)[0] > int(grey >> 16 & 255U) + 20 ? 'e' : 'g';
        if (across.empty() || across.back() != kind) {
            across += kind;
        }
    }
    EXPECT_EQ(across, "gegeg");
}

TEST(BaseMap, IsAskedForOnThePlaneOfThePicture) {
    for (const auto* crs : {"", "EPSG:32633"}) {
        auto scene = bare_crossing();
        if (*crs != '\0') {
            scene.projection = plane_projection(crs);
        }
        std::optional<PicturePlane> asked;
        const auto base = painted(patterned);
        scene.base = std::make_shared<BaseMap>(BaseMap{{}, [&](const PicturePlane& plane) {
                                                           asked = plane;
                                                           return base->laid_on(plane);
                                                       }});
        render_map(scene, plain, {500, 400});
        const auto place = MapPlan(scene, plain, {500, 400}).place();
        ASSERT_TRUE(asked);
        EXPECT_EQ(asked->wkt, scene.projection ? scene.projection->wkt : "");
        EXPECT_EQ(asked->left, place.left);
        EXPECT_EQ(asked->top, place.top);
        EXPECT_EQ(asked->per_px, place.per_px);
        EXPECT_EQ(asked->width_px, 500);
        EXPECT_EQ(asked->height_px, 400);
    }
}

TEST(BaseMap, IsTheSameInBandsAsWhole) {
    auto scene = crossing();
    scene.title = "Town";
    scene.base = painted(patterned);
    const auto drawn = [&](int band_px) {
        std::vector<std::uint8_t> rgb;
        MapPlan{scene, {}, {700, 520, band_px}}.draw([&](std::span<const std::uint8_t> rows) {
            rgb.insert(rgb.end(), rows.begin(), rows.end());
        });
        return rgb;
    };
    const auto whole = drawn(520);
    for (const int band_px : {1, 23, 64, 519}) {
        EXPECT_TRUE(drawn(band_px) == whole) << band_px;
    }
}

TEST(BaseMap, HasNoSeamBetweenThePartsThatOpenGlDrawsAtOnce) {
    // A sheet wider than a window, and so high that its ground comes in several chunks.
    constexpr int width_px = 8192 + 300;
    constexpr int height_px = 600;
    const PixelBox map{0, 17, width_px, height_px - 9};
    const auto base = painted(patterned)->laid_on({});
    const auto colours = palette(MapStyle{});
    const auto image =
        painted_roads({width_px, height_px, map, ground_with(base, {colours.ground, 1})},
                      {},
                      {1, 1},
                      colours,
                      {});
    for (int y = 0; y < height_px; ++y) {
        for (int x = 0; x < width_px; ++x) {
            const bool inside = y >= 17 && y < height_px - 9;
            ASSERT_EQ(at(image, x, y), inside ? patterned(x, y) : colour_of(colours.page))
                << x << ", " << y;
        }
    }
}

// ---------------------------------------------------------------------------------- on paper

class BaseMapOnPaper : public ::testing::Test {
protected:
    std::string pdf_of(const MapScene& scene, const MapStyle& style) const {
        return MapPlan{scene, style, {1240, 877}}.pdf({.width_px = 1240,
                                                       .height_px = 877,
                                                       .px_per_inch = 150,
                                                       .title = {},
                                                       .author = {},
                                                       .made = {}});
    }

    std::string written(const std::string& pdf) const {
        auto file = (folder_ / "map.pdf").string();
        std::ofstream{file, std::ios::binary} << pdf;
        return file;
    }

    fs::path folder_ = test_folder();
};

TEST_F(BaseMapOnPaper, IsOnePictureUnderRoadsThatStayLines) {
    auto scene = crossing();
    scene.title = "Town";
    scene.base = painted(patterned);
    const auto images = output_of(folder_, "pdfimages -list " + written(pdf_of(scene, {})));
    EXPECT_EQ(std::ranges::count(images, '\n'), 3) << images; // under the table's head
    EXPECT_THAT(images, HasSubstr(" 1240 "));
    EXPECT_THAT(output_of(folder_, "pdftotext " + (folder_ / "map.pdf").string() + " -"),
                HasSubstr("Town"));
}

TEST_F(BaseMapOnPaper, LooksAsInThePicture) {
    auto scene = crossing();
    scene.base = painted([](int x, int y) {
        return Pixel{x / 5 & 255, y / 4 & 255, x + y < 1000 ? 200 : 30, 255};
    });
    const auto pdf = written(pdf_of(scene, {}));
    ASSERT_EQ(output_of(folder_,
                        "pdftoppm -r 150 -singlefile " + pdf + " " + (folder_ / "page").string()),
              "");
    std::istringstream in{content_of(folder_ / "page.ppm")};
    std::string magic;
    Image page;
    int most = 0;
    in >> magic >> page.width >> page.height >> most;
    in.get();
    page.rgb.assign(std::istreambuf_iterator<char>{in}, {});
    MapStyle style;
    style.labels = false; // the names of roads are not drawn on paper
    const auto picture = render_map(scene, style, {1240, 877});
    ASSERT_EQ(page.rgb.size(), picture.rgb.size());
    double sum = 0;
    for (std::size_t i = 0; i < page.rgb.size(); ++i) {
        sum += std::abs(int(page.rgb[i]) - int(picture.rgb[i]));
    }
    EXPECT_LT(sum / double(page.rgb.size()), 1.0); // as without a base map
}

TEST_F(BaseMapOnPaper, IsTheSameByteForByteEachTime) {
    auto scene = crossing();
    scene.base = painted(patterned);
    EXPECT_TRUE(pdf_of(scene, {}) == pdf_of(scene, {}));
}

} // namespace macadam::testing
