#include "mapping/geometry/antimeridian.hpp"

#include <gmock/gmock.h>

namespace macadam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;
using Line = std::vector<GeoPoint>;

TEST(Antimeridian, LeavesALineThatStaysOnItsSideAsItIs) {
    const Line line{{10, 179}, {11, 180}, {12, 179.5}};
    EXPECT_FALSE(crosses_antimeridian(line));
    EXPECT_THAT(cut_at_antimeridian(line), ElementsAre(line));
    EXPECT_EQ(unwrapped(line, 170), line);
}

TEST(Antimeridian, CutsALineWhereItMeetsTheMeridian) {
    const Line east{{10, 179}, {14, -177}}; // a quarter of the way is before it
    EXPECT_TRUE(crosses_antimeridian(east));
    EXPECT_THAT(cut_at_antimeridian(east),
                ElementsAre(Line{{10, 179}, {11, 180}}, Line{{11, -180}, {14, -177}}));
    const Line west{{14, -177}, {10, 179}};
    EXPECT_THAT(cut_at_antimeridian(west),
                ElementsAre(Line{{14, -177}, {11, -180}}, Line{{11, 180}, {10, 179}}));
}

TEST(Antimeridian, CutsALineAsOftenAsItCrosses) {
    const Line line{{0, 179}, {0, -179}, {2, -179}, {2, 179}};
    EXPECT_THAT(cut_at_antimeridian(line),
                ElementsAre(Line{{0, 179}, {0, 180}},
                            Line{{0, -180}, {0, -179}, {2, -179}, {2, -180}},
                            Line{{2, 180}, {2, 179}}));
}

TEST(Antimeridian, MakesNoPartOfOnePoint) {
    const Line ends_on_it{{0, 179}, {0, 180}, {0, -179}};
    EXPECT_THAT(cut_at_antimeridian(ends_on_it),
                ElementsAre(Line{{0, 179}, {0, 180}}, Line{{0, -180}, {0, -179}}));
    const Line begins_on_it{{0, 180}, {0, -179}};
    EXPECT_THAT(cut_at_antimeridian(begins_on_it), ElementsAre(Line{{0, -180}, {0, -179}}));
}

TEST(Antimeridian, CutsALineOverAPoleLikeAnyOther) {
    const Line line{{89.9, 100}, {89.9, -81}}; // 179 degrees on, over the meridian
    const auto parts = cut_at_antimeridian(line);
    ASSERT_THAT(parts, SizeIs(2));
    EXPECT_EQ(parts[0].back(), (GeoPoint{89.9, 180}));
    EXPECT_EQ(parts[1].front(), (GeoPoint{89.9, -180}));
}

TEST(Antimeridian, LetsLongitudesGoOnWhereALineIsUnwrapped) {
    const Line line{{0, 179}, {0, -179}, {0, -178}, {0, 179.5}};
    EXPECT_EQ(unwrapped(line, 175), (Line{{0, 179}, {0, 181}, {0, 182}, {0, 179.5}}));
    EXPECT_EQ(unwrapped(line, -175), (Line{{0, -181}, {0, -179}, {0, -178}, {0, -180.5}}));
}

TEST(Antimeridian, DividesABoxThatGoesOverIt) {
    EXPECT_THAT(parts_on_globe({170, -5, 190, 5}),
                ElementsAre(GeoBox{170, -5, 180, 5}, GeoBox{-180, -5, -170, 5}));
    EXPECT_THAT(parts_on_globe({-10, -5, 10, 5}), ElementsAre(GeoBox{-10, -5, 10, 5}));
    EXPECT_THAT(parts_on_globe({185, -5, 190, 5}), ElementsAre(GeoBox{-175, -5, -170, 5}));
}

TEST(Antimeridian, GrowsABoxThatGoesOverItOnBothSides) {
    const auto large = grown_over({179.9, 0, 180.1, 0.2}, 1000);
    const auto elsewhere = grown({-0.1, 0, 0.1, 0.2}, 1000); // the same box, turned by half
    EXPECT_NEAR(large.west_deg, elsewhere.west_deg + 180, 1e-9);
    EXPECT_NEAR(large.east_deg, elsewhere.east_deg + 180, 1e-9);
    EXPECT_EQ(large.north_deg, elsewhere.north_deg);
}

} // namespace
} // namespace macadam::testing
