#include "render/roads/road_polylines.hpp"

#include "render/roads/stroke_geometry.hpp"

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

std::vector<StrokeQuad> stroke_of(const Polyline& polyline, const StrokePass& pass) {
    std::vector<StrokeQuad> quads;
    append_stroke(quads, polyline, pass);
    return quads;
}

double distance_px(const Polyline& polyline, const PixelPoint& at) {
    double least = 1e9;
    for (std::size_t i = 0; i + 1 < polyline.points.size(); ++i) {
        const auto& a = polyline.points[i];
        const auto& b = polyline.points[i + 1];
        for (double t = 0; t <= 1; t += 1.0 / 256) {
            const double x = std::lerp(a.x, b.x, t);
            const double y = std::lerp(a.y, b.y, t);
            least = std::min(least, std::hypot(at.x - x, at.y - y));
        }
    }
    return least;
}

/// A winding road of one line every 40 px, from the west to the east.
std::vector<MapLine> winding_road(int first, int count) {
    std::vector<MapLine> lines;
    for (int i = first; i < first + count; ++i) {
        const double x = 40.0 * i;
        const auto y = [](double at_px) { return 500 + 30 * std::sin(at_px / 25); };
        lines.push_back(line({{x, y(x)}, {x + 15, y(x + 15)}, {x + 40, y(x + 40)}}, i % 3));
    }
    return lines;
}

std::vector<PixelPoint> drawn_points(const Polyline& polyline) {
    return {polyline.points.begin() + std::ptrdiff_t(polyline.first),
            polyline.points.begin() + std::ptrdiff_t(polyline.past) + 1};
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
    EXPECT_THAT(polyline_of(lines, chain, frame).looks, ::testing::ElementsAre(look_of(1, true)));
}

TEST(RoadPolylines, KeepEveryBendWithinATenthOfAPixel) {
    std::vector<PixelPoint> arc;
    for (int i = 0; i <= 2000; ++i) {
        const double angle = std::numbers::pi * i / 2000;
        arc.push_back({500 + 200 * std::cos(angle), 500 + 200 * std::sin(angle)});
    }
    const std::vector lines{line(arc, 0)};
    const auto polyline = polyline_of(lines, {{0}}, frame);
    EXPECT_LT(polyline.points.size(), 200U);
    for (std::size_t i = 0; i < arc.size(); i += 7) {
        EXPECT_LT(distance_px(polyline, arc[i]), 0.1); // 0.05 px aside, and the oracle's own steps
    }
}

TEST(RoadPolylines, ShowTheWorstOfWhatIsTooShortToSee) {
    const std::vector lines{line({{100, 100}, {100.1, 100}}, 2),
                            line({{100.1, 100}, {100.2, 100}}, 0),
                            line({{100.2, 100}, {110, 100}}, 1)};
    EXPECT_THAT(polyline_of(lines, {{0}, {1}, {2}}, frame).looks,
                ::testing::ElementsAre(look_of(2, true), look_of(1, true)));
}

TEST(RoadPolylines, RunBackwardsWhereALineIsReversed) {
    const std::vector lines{line({{100, 100}, {200, 100}}, 0)};
    const auto polyline = polyline_of(lines, {{0, true}}, frame);
    EXPECT_NEAR(polyline.points.front().x, 200, 1e-5);
    EXPECT_NEAR(polyline.points.back().x, 100, 1e-5);
}

TEST(RoadPolylines, AreOneForEachLineWhereTheyAreSeparate) {
    const auto lines = winding_road(0, 5);
    const auto polylines = separate_polylines(lines, all_lines(lines), frame);
    ASSERT_EQ(polylines.size(), lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto alone = polyline_of(lines, {{i}}, frame);
        EXPECT_EQ(drawn_points(polylines[i]), alone.points) << i;
        EXPECT_EQ(polylines[i].looks[polylines[i].first], look_of(int(i) % 3, true)) << i;
    }
}

TEST(RoadPolylines, DependOnNoDistantLineWhereTheyAreSeparate) {
    const auto road = winding_road(0, 12);
    const auto near = winding_road(3, 5); // the lines 3 to 7 of the road
    const auto all = separate_polylines(road, all_lines(road), frame);
    const auto some = separate_polylines(near, all_lines(near), frame);
    ASSERT_EQ(all.size(), road.size());
    ASSERT_EQ(some.size(), near.size());
    for (const double right_px : {0.0, 4.0}) {
        const StrokePass pass{.radius_px = 5, .looks = every_look, .visible = {0, 0, 1000, 1000}};
        const auto quads_of = [&](const Polyline& polyline) {
            std::vector<float> corners;
            for (const auto& quad : stroke_of(beside(polyline, right_px), pass)) {
                for (const auto& corner : quad) {
                    corners.insert(corners.end(), {corner.x_px, corner.y_px, corner.round_after});
                }
            }
            return corners;
        };
        const auto whole = quads_of(all[5]);
        ASSERT_FALSE(whole.empty());
        EXPECT_EQ(whole, quads_of(some[2])) << right_px;
    }
}

TEST(RoadPolylines, CloseARingWhereTheyAreSeparate) {
    std::vector<MapLine> ring;
    const auto at = [](int i) {
        const double angle = 2 * std::numbers::pi * i / 12;
        return PixelPoint{500 + 60 * std::cos(angle), 500 + 60 * std::sin(angle)};
    };
    for (int i = 0; i < 12; ++i) {
        ring.push_back(line({at(i), at((i + 1) % 12)}, 1));
    }
    const auto polylines = separate_polylines(ring, all_lines(ring), frame);
    ASSERT_EQ(polylines.size(), ring.size());
    for (const auto& polyline : polylines) {
        EXPECT_EQ(polyline.first, 2U); // two line segments before the line, and two after it
        EXPECT_EQ(polyline.looks.size(), 5U);
        const auto quads = stroke_of(polyline, {5, every_look, {0, 0, 1000, 1000}});
        ASSERT_FALSE(quads.empty());
        for (const auto& quad : quads) {
            EXPECT_EQ(quad[0].round_before, 0); // mitred, also where the ring's numbers begin
            EXPECT_EQ(quad[0].round_after, 0);
        }
    }
}

} // namespace macadam::testing
