#include "render/roads/road_polylines.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace macadam::testing {
namespace {

const MapFrame frame = fitted_frame({16, 48, 16.01, 48.01}, {0, 0, 1000, 1000});

MapLine line(const std::vector<PixelPoint>& pixels, int iri_class) {
    MapLine made;
    for (const auto& pixel : pixels) {
        made.line.push_back(to_geo(frame, pixel));
    }
    made.iri_class = iri_class;
    return made;
}

double distance_px(const Polyline& strand, const PixelPoint& at) {
    double least = 1e9;
    for (std::size_t i = 0; i + 1 < strand.points.size(); ++i) {
        const auto& a = strand.points[i];
        const auto& b = strand.points[i + 1];
        for (double t = 0; t <= 1; t += 1.0 / 256) {
            const double x = std::lerp(a.x, b.x, t);
            const double y = std::lerp(a.y, b.y, t);
            least = std::min(least, std::hypot(at.x - x, at.y - y));
        }
    }
    return least;
}

} // namespace

TEST(RoadPolylines, MakeOnePieceOfAStraightRoad) {
    std::vector<MapLine> lines;
    std::vector<LineUse> chain;
    for (std::size_t i = 0; i < 30; ++i) {
        const double x = 10.0 * double(i);
        lines.push_back(line({{x, 500}, {x + 10, 500}}, 1));
        chain.push_back({i});
    }
    EXPECT_THAT(strand_of(lines, chain, frame).looks, ::testing::ElementsAre(look_of(1, true)));
}

TEST(RoadPolylines, KeepEveryBendWithinATenthOfAPixel) {
    std::vector<PixelPoint> arc;
    for (int i = 0; i <= 2000; ++i) {
        const double angle = std::numbers::pi * i / 2000;
        arc.push_back({500 + 200 * std::cos(angle), 500 + 200 * std::sin(angle)});
    }
    const std::vector lines{line(arc, 0)};
    const auto strand = strand_of(lines, {{0}}, frame);
    EXPECT_LT(strand.points.size(), 200U);
    for (std::size_t i = 0; i < arc.size(); i += 7) {
        EXPECT_LT(distance_px(strand, arc[i]), 0.1); // 0.05 px aside, and the oracle's own steps
    }
}

TEST(RoadPolylines, ShowTheWorstOfWhatIsTooShortToSee) {
    const std::vector lines{line({{100, 100}, {100.1, 100}}, 2),
                            line({{100.1, 100}, {100.2, 100}}, 0),
                            line({{100.2, 100}, {110, 100}}, 1)};
    EXPECT_THAT(strand_of(lines, {{0}, {1}, {2}}, frame).looks,
                ::testing::ElementsAre(look_of(2, true), look_of(1, true)));
}

TEST(RoadPolylines, RunBackwardsWhereALineIsReversed) {
    const std::vector lines{line({{100, 100}, {200, 100}}, 0)};
    const auto strand = strand_of(lines, {{0, true}}, frame);
    EXPECT_NEAR(strand.points.front().x, 200, 1e-5);
    EXPECT_NEAR(strand.points.back().x, 100, 1e-5);
}

} // namespace macadam::testing
