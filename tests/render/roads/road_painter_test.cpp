#include "render/roads/road_painter.hpp"

#include "render/gl/gl_context.hpp"
#include "render/roads/road_polylines.hpp"

#include "estimator/common/error.hpp"

#include <GL/gl.h>
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <span>
#include <vector>

namespace macadam::testing {
namespace {

constexpr std::uint32_t good = 0x2c7bb6;
constexpr std::uint32_t poor = 0xd7191c;
constexpr std::array<std::uint32_t, 2> classes{good, poor};
const Palette colours = palette(MapStyle::Theme::light);
const LineWidths widths{.core_px = 6, .casing_px = 2};
const Sheet sheet{64, 48, {0, 0, 64, 48}};

/// Rank 3 draws widths as they are.
Polyline strand(std::vector<PixelPoint> points, std::vector<int> looks) {
    return {.points = std::move(points), .looks = std::move(looks), .rank = 3};
}

Image painted(const std::vector<Polyline>& strands) {
    return painted_roads(sheet, strands, widths, colours, classes);
}

std::uint32_t pixel(const Image& image, int x, int y) {
    const auto* rgb = image.rgb.data() + (std::size_t(y) * image.width + std::size_t(x)) * 3;
    return std::uint32_t(rgb[0]) << 16 | std::uint32_t(rgb[1]) << 8 | rgb[2];
}

/// The same pictures by another road: distance of each pixel from each piece, capsule by capsule.
class Reference {
public:
    Reference() : rgb_(std::size_t(sheet.width_px * sheet.height_px)) {
        for (auto& pixel : rgb_) {
            pixel = channels(colours.ground);
        }
    }

    void draw(const Polyline& road, double radius_px, std::uint32_t rgb) {
        for (int y = 0; y < sheet.height_px; ++y) {
            for (int x = 0; x < sheet.width_px; ++x) {
                const double share =
                    std::clamp(radius_px + 0.5 - away_px(road, x + 0.5, y + 0.5), 0.0, 1.0);
                auto& below = rgb_[std::size_t(y * sheet.width_px + x)];
                const auto above = channels(rgb);
                for (std::size_t i = 0; i < 3; ++i) {
                    below[i] += (above[i] - below[i]) * share;
                }
            }
        }
    }

    double max_difference(const Image& image) const {
        double most = 0;
        for (std::size_t i = 0; i < rgb_.size() * 3; ++i) {
            most = std::max(most, std::abs(rgb_[i / 3][i % 3] - image.rgb[i]));
        }
        return most;
    }

private:
    static std::array<double, 3> channels(std::uint32_t rgb) {
        return {double(rgb >> 16 & 255U), double(rgb >> 8 & 255U), double(rgb & 255U)};
    }

    static double away_px(const Polyline& road, double x, double y) {
        double least = 1e9;
        for (std::size_t i = 0; i + 1 < road.points.size(); ++i) {
            const auto& a = road.points[i];
            const double dx = road.points[i + 1].x - a.x;
            const double dy = road.points[i + 1].y - a.y;
            const double t =
                std::clamp(((x - a.x) * dx + (y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
            least = std::min(least, std::hypot(x - a.x - t * dx, y - a.y - t * dy));
        }
        return least;
    }

    std::vector<std::array<double, 3>> rgb_;
};

double difference_from_reference(const std::vector<Polyline>& strands) {
    Reference reference;
    for (const auto& road : strands) {
        reference.draw(road, 5, colours.casing);
    }
    for (const auto& road : strands) {
        reference.draw(road, 3, road.looks[0] == look_of(0, true) ? good : poor);
    }
    return reference.max_difference(painted(strands));
}

const Polyline level = strand({{10, 20}, {50, 20}}, {look_of(1, true)});

} // namespace

TEST(RoadPainter, SetsTheSubjectOffFromNeighboursOfItsColour) {
    auto subject = strand({{10, 24}, {54, 24}}, {look_of(1, true)});
    subject.rank = subject_rank;
    const auto neighbour = strand({{30, 4}, {30, 44}}, {look_of(1, true)});
    const auto image = painted({subject, neighbour});
    EXPECT_EQ(pixel(image, 30, 24), poor);
    const double core_px = core_radius_px(widths, subject_rank, true);
    const double edge_px = subject_edge_radius_px(widths);
    const double air_px = subject_air_radius_px(widths);
    EXPECT_GT(edge_px, casing_radius_px(widths, 0, true)) << "no wider than of any other road";
    EXPECT_EQ(pixel(image, 30, int(24 - (core_px + edge_px) / 2)), colours.casing);
    EXPECT_EQ(pixel(image, 30, int(24 - (edge_px + air_px) / 2)), colours.ground);
    EXPECT_EQ(pixel(image, 30, int(24 - air_px - 3)), poor) << "of the neighbour";
}

TEST(RoadPainter, ShowsTheClassInTheMiddleCasingBesideItAndGroundElsewhere) {
    const auto image = painted({level});
    for (const int y : {17, 19, 20, 22}) {
        EXPECT_EQ(pixel(image, 30, y), poor) << y;
    }
    for (const int y : {15, 16, 23, 24}) {
        EXPECT_EQ(pixel(image, 30, y), colours.casing) << y;
    }
    for (const int y : {0, 14, 25, 47}) {
        EXPECT_EQ(pixel(image, 30, y), colours.ground) << y;
    }
}

TEST(RoadPainter, SmoothsBothEdgesAlike) {
    const auto image = painted({strand({{0, 20.5}, {64, 20.5}}, {look_of(0, true)})});
    for (int away = 0; away < 8; ++away) {
        EXPECT_EQ(pixel(image, 30, 20 - away), pixel(image, 30, 20 + away)) << away;
    }
    const auto edge = pixel(image, 30, 15); // half covered
    EXPECT_NE(edge, colours.ground);
    EXPECT_NE(edge, colours.casing);
}

TEST(RoadPainter, AgreesWithDistancesOnASlantingRoad) {
    // 8 bits a channel, blended twice, and coordinates of 1/256 px in the rasteriser.
    EXPECT_LE(difference_from_reference({strand({{9.3, 8.1}, {51.7, 39.4}}, {look_of(0, true)})}),
              3);
}

TEST(RoadPainter, AgreesWithDistancesWhereRoadsCross) {
    EXPECT_LE(difference_from_reference({strand({{9.3, 8.1}, {51.7, 39.4}}, {look_of(0, true)}),
                                         strand({{12.2, 41.6}, {50.1, 6.3}}, {look_of(1, true)})}),
              3);
}

TEST(RoadPainter, AgreesWithDistancesAlongACurve) {
    std::vector<PixelPoint> points;
    for (int i = 0; i <= 12; ++i) {
        points.push_back({32 + 18 * std::cos(i * 0.25), 12 + 18 * std::sin(i * 0.25)});
    }
    const Polyline curve = strand(points, std::vector(12, look_of(1, true)));
    // A mitre reaches r (1 / cos(bend / 2) - 1) = 0.04 px beyond the round corner of the oracle: 10
    // of 255 levels at most.
    EXPECT_LE(difference_from_reference({curve}), 12);
}

TEST(RoadPainter, AgreesWithDistancesOnAPieceThatIsLongerThanAnyPicture) {
    for (const double far : {1e4, 1e5, 1e6}) {
        EXPECT_LE(
            difference_from_reference({strand(
                {{30 - 2 * far, 20.3 - far}, {30 + far, 20.3 + far / 2}}, {look_of(0, true)})}),
            3)
            << far;
    }
}

TEST(RoadPainter, FillsSharpBendsAndPiecesShorterThanTheirWidth) {
    const Polyline zigzag =
        strand({{12, 12}, {40, 14}, {40.5, 14.8}, {39, 15.5}, {14, 30}, {50, 38}},
               std::vector(5, look_of(1, true)));
    const auto image = painted({zigzag});
    for (const auto& [x, y] : {std::pair{12, 12}, {40, 14}, {39, 15}, {14, 30}, {49, 37}}) {
        EXPECT_EQ(pixel(image, x, y), poor) << x << ' ' << y;
    }
}

TEST(RoadPainter, ChangesClassWithoutAGapOrABead) {
    const auto image =
        painted({strand({{4, 20}, {30, 20}, {60, 20}}, {look_of(0, true), look_of(1, true)})});
    for (int y = 17; y < 23; ++y) {
        EXPECT_EQ(pixel(image, 28, y), good) << y;
        EXPECT_EQ(pixel(image, 31, y), poor) << y;
    }
    EXPECT_EQ(pixel(image, 29, 16), colours.casing);
}

TEST(RoadPainter, PaintsTheWorseOverTheBetter) {
    const auto better = strand({{10, 20}, {50, 20}}, {look_of(0, true)});
    EXPECT_EQ(pixel(painted({level, better}), 30, 20), poor);
    EXPECT_EQ(pixel(painted({better, level}), 30, 20), poor);
}

TEST(RoadPainter, PaintsTheLargerRoadOverTheSmaller) {
    auto street = strand({{30, 4}, {30, 44}}, {look_of(1, true)});
    auto motorway = strand({{4, 20}, {60, 20}}, {look_of(0, true)});
    street.rank = 5;
    motorway.rank = 0;
    EXPECT_EQ(pixel(painted({motorway, street}), 30, 20), good);
}

TEST(RoadPainter, LaysUnmeasuredRoadsBelowAllOthers) {
    auto unmeasured = strand({{30, 4}, {30, 44}}, {unmeasured_look});
    unmeasured.rank = 0;
    const auto image = painted({level, unmeasured});
    EXPECT_EQ(pixel(image, 30, 20), poor);
    EXPECT_EQ(pixel(image, 30, 40), colours.unmeasured);
    EXPECT_EQ(pixel(image, 35, 40), colours.ground);
}

TEST(RoadPainter, DrawsAnUncertainRoadThinner) {
    const auto image = painted({strand({{10, 20}, {50, 20}}, {look_of(1, false)})});
    EXPECT_EQ(pixel(image, 30, 20), poor);
    EXPECT_EQ(pixel(image, 30, 22), colours.casing);
    EXPECT_EQ(pixel(image, 30, 24), colours.ground);
}

TEST(RoadPainter, StaysOnTheMap) {
    const Sheet framed{64, 48, {0, 10, 64, 40}};
    const auto image = painted_roads(framed,
                                     std::vector{strand({{30, 0}, {30, 48}}, {look_of(1, true)})},
                                     widths,
                                     colours,
                                     classes);
    EXPECT_EQ(pixel(image, 30, 9), colours.page);
    EXPECT_EQ(pixel(image, 30, 10), poor);
    EXPECT_EQ(pixel(image, 30, 39), poor);
    EXPECT_EQ(pixel(image, 30, 40), colours.page);
}

TEST(RoadPainter, MovesALineToTheRightOfItsDirection) {
    const auto moved = beside(strand({{10, 20}, {30, 20}, {30, 40}}, {1, 1}), 4);
    // Eastwards, then south: right is below, then left.
    EXPECT_THAT(moved.points,
                ::testing::ElementsAre(PixelPoint{10, 24}, PixelPoint{26, 24}, PixelPoint{26, 40}));
}

TEST(GlContext, RefusesWhatOsmesaWouldDrawWrongly) {
    EXPECT_THAT([] { GlContext({}, 20000, 1); },
                ::testing::ThrowsMessage<InputError>("'20000x1', expected sides of 1 to 16384 px"));
}

TEST(GlContext, RefusesAnUnknownLibrary) {
    setenv("MACADAM_OPENGL", "vulkan", 1);
    std::vector<std::uint8_t> rgba(4);
    EXPECT_THAT(
        [&] { GlContext(rgba, 1, 1); },
        ::testing::ThrowsMessage<InputError>("MACADAM_OPENGL is 'vulkan', expected osmesa or egl"));
    unsetenv("MACADAM_OPENGL");
}

namespace {

/// Clears a context to red (0) or green (1).
void clear(const GlContext& context, int channel) {
    context.make_current();
    context.entry<decltype(&glClearColor)>("glClearColor")(
        channel == 0 ? 1 : 0, channel == 1 ? 1 : 0, 0, 1);
    context.entry<decltype(&glClear)>("glClear")(GL_COLOR_BUFFER_BIT);
}

} // namespace

TEST(GlContext, OfEglDrawsIntoItsOwnMemoryBesideOthers) {
    setenv("MACADAM_OPENGL", "egl", 1);
    std::vector<std::uint8_t> red(2 * 3 * 4), green(1 * 1 * 4);
    {
        const GlContext first{red, 2, 3};
        const GlContext second{green, 1, 1};
        clear(first, 0);
        clear(second, 1);
        second.finish();
        first.make_current();
        first.finish();
    }
    unsetenv("MACADAM_OPENGL");
    EXPECT_THAT(green, ::testing::ElementsAre(0, 255, 0, 255));
    for (std::size_t i = 0; i < red.size(); i += 4) {
        EXPECT_THAT(std::span{red}.subspan(i, 4), ::testing::ElementsAre(255, 0, 0, 255));
    }
}

} // namespace macadam::testing
