#include "render/background/coverage_mask.hpp"

#include "render/background/line_outline.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace macadam {
namespace {

using Ring = std::vector<PixelPoint>;

/// Grey levels of a part with black rings on white.
std::vector<int> painted(const PicturePart& part, const std::vector<Ring>& rings) {
    std::vector<std::uint8_t> rgba(std::size_t(part.width_px * part.height_px) * 4, 255);
    CoverageMask mask{part};
    for (const auto& ring : rings) {
        mask.add(ring);
    }
    mask.paint(rgba, 0x000000);
    std::vector<int> grey;
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        grey.push_back(rgba[i]);
    }
    return grey;
}

double ink_of(const std::vector<int>& grey) {
    double ink = 0;
    for (const int level : grey) {
        ink += (255 - level) / 255.0;
    }
    return ink;
}

Ring circle(double x, double y, double radius, int corners = 90) {
    Ring ring;
    for (int i = 0; i < corners; ++i) {
        const double turn = 2 * std::numbers::pi * i / corners;
        ring.push_back({x + radius * std::cos(turn), y + radius * std::sin(turn)});
    }
    return ring;
}

Ring reversed(Ring ring) {
    return {ring.rbegin(), ring.rend()};
}

constexpr PicturePart whole{0, 0, 40, 40};

TEST(CoverageMask, CoversAPixelByTheShareOfItThatIsInside) {
    const auto grey = painted({0, 0, 2, 1}, {{{0.25, 0}, {1.5, 0}, {1.5, 1}, {0.25, 1}}});
    EXPECT_EQ(grey, (std::vector{64, 128})); // 75 and 50 % of black
}

TEST(CoverageMask, CoversTheAreaOfACircleWithoutThatOfItsHole) {
    const auto ring = circle(20.3, 19.6, 15);
    const double area = 45 * 15 * 15 * std::sin(2 * std::numbers::pi / 90);
    EXPECT_NEAR(ink_of(painted(whole, {ring})), area, 0.5); // 0.2 % of 94 px of rim, rounded
    const auto hole = reversed(circle(20.3, 19.6, 5));
    EXPECT_NEAR(ink_of(painted(whole, {ring, hole})), area * (1 - 1.0 / 9), 0.5);
}

TEST(CoverageMask, ShowsNoSeamBetweenPolygonsThatMeetAlongASlantedLine) {
    const Ring left{{0, 0}, {13.3, 0}, {22.7, 40}, {0, 40}};
    const Ring right{{13.3, 0}, {40, 0}, {40, 40}, {22.7, 40}};
    for (const int level : painted(whole, {left, right})) {
        ASSERT_EQ(level, 0);
    }
}

TEST(CoverageMask, PaintsAPixelAlikeInWhateverPart) {
    const std::vector<Ring> rings{circle(20.3, 19.6, 15), circle(8.1, 30.2, 11, 7)};
    const auto all = painted(whole, rings);
    constexpr PicturePart part{11, 7, 13, 21};
    const auto some = painted(part, rings);
    for (int y = 0; y < part.height_px; ++y) {
        for (int x = 0; x < part.width_px; ++x) {
            ASSERT_EQ(some[std::size_t(y * part.width_px + x)],
                      all[std::size_t((y + part.top_px) * whole.width_px + x + part.left_px)])
                << x << ' ' << y;
        }
    }
}

TEST(CoverageMask, BearsPolygonsFarBeyondThePicture) {
    EXPECT_NEAR(
        ink_of(painted(whole, {{{-1e9, -1e9}, {1e9, -1e9}, {1e9, 1e9}, {-1e9, 1e9}}})), 1600, 1e-9);
    EXPECT_EQ(ink_of(painted(whole, {{{1e300, 1e300}, {-1e300, 1e300}, {3, 1e301}}})), 0);
}

TEST(LineOutline, HasTheAreaOfTheLineTimesItsWidthAlsoInDashes) {
    std::vector<Ring> line;
    append_outline(line, Ring{{5, 5}, {20, 5}, {35, 5}}, {.radius_px = 1.5});
    EXPECT_NEAR(ink_of(painted(whole, line)), 30 * 3, 0.2);
    std::vector<Ring> dashes;
    append_outline(dashes, Ring{{5, 5}, {20, 5}, {35, 5}}, {.radius_px = 1.5, .period_px = 6});
    EXPECT_NEAR(ink_of(painted(whole, dashes)), 15 * 3, 0.2);
}

TEST(LineOutline, FillsTheOuterSideOfBends) {
    for (const double side : {-10, 10}) { // to either side
        std::vector<Ring> line;
        append_outline(line, Ring{{5, 20}, {20, 20}, {20, 20 + side}}, {.radius_px = 3});
        const auto grey = painted(whole, line);
        const int corner = side > 0 ? 18 : 21; // within the bevel
        EXPECT_EQ(grey[std::size_t(corner * whole.width_px + 20)], 0) << side;
    }
}

} // namespace
} // namespace macadam
