#include "render/projection/crs_projection.hpp"

#include "estimator/common/error.hpp"
#include "render/map/map_plan.hpp"
#include "render/projection/projection.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace macadam::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

constexpr double rad_per_deg = std::numbers::pi / 180;

TEST(PlaneProjection, MeetsTheControlPointsOfSweref99Tm) {
    // Lantmäteriet, "Kontrollpunkter": latitude, longitude, north, east.
    const auto sweden = plane_projection("EPSG:3006");
    const auto a = sweden->to_plane({55, 12.75}).value();
    EXPECT_NEAR(a.y, 6097106.672, 0.001);
    EXPECT_NEAR(a.x, 356083.438, 0.001);
    const auto b = sweden->to_plane({57, 19.5}).value();
    EXPECT_NEAR(b.y, 6326392.707, 0.001);
    EXPECT_NEAR(b.x, 773251.054, 0.001);
    const auto back = sweden->to_geo(b).value();
    EXPECT_NEAR(back.lat_deg, 57, 1e-9);
    EXPECT_NEAR(back.lon_deg, 19.5, 1e-9);
}

TEST(PlaneProjection, PutsEastToTheRightWhateverTheOrderOfAxes) {
    for (const auto* crs : {"EPSG:3006", "EPSG:4326", "EPSG:31287", "EPSG:2193", "EPSG:3346"}) {
        const bool south = crs == std::string{"EPSG:2193"}; // New Zealand
        const GeoPoint at = south ? GeoPoint{-41, 173} : GeoPoint{55, 15};
        const auto plane = plane_projection(crs);
        const auto here = plane->to_plane(at).value();
        EXPECT_GT(plane->to_plane({at.lat_deg, at.lon_deg + 0.1}).value().x, here.x) << crs;
        EXPECT_GT(plane->to_plane({at.lat_deg + 0.1, at.lon_deg}).value().y, here.y) << crs;
    }
}

TEST(PlaneProjection, TakesProjStringsAndNamesItselfInWkt) {
    const auto plane = plane_projection("+proj=laea +lat_0=52 +lon_0=10 +datum=WGS84");
    const auto middle = plane->to_plane({52, 10}).value();
    EXPECT_NEAR(middle.x, 0, 1e-6);
    EXPECT_NEAR(middle.y, 0, 1e-6);
    EXPECT_THAT(plane_projection("EPSG:3857")->wkt, HasSubstr("AUTHORITY[\"EPSG\",\"3857\"]"));
}

TEST(PlaneProjection, MeetsTheMercatorOfPictures) {
    const auto mercator = plane_projection("EPSG:3857");
    const GeoBox box{16, 48, 16.5, 48.2};
    const PixelBox room{0, 0, 1000, 700};
    const auto ours = fitted_frame(box, room);
    const auto theirs = fitted_frame(box, room, mercator.get());
    for (const GeoPoint place : {GeoPoint{48, 16}, {48.2, 16.5}, {48.05, 16.3}}) {
        EXPECT_NEAR(to_pixel(ours, place).x, to_pixel(theirs, place).x, 1e-6);
        EXPECT_NEAR(to_pixel(ours, place).y, to_pixel(theirs, place).y, 1e-6);
    }
    EXPECT_NEAR(metres_per_px(ours, 350), metres_per_px(theirs, 350), 1e-4);
    EXPECT_NEAR(plane_position(ours).left, plane_position(theirs).left, 1e-4);
    EXPECT_NEAR(plane_position(ours).top, plane_position(theirs).top, 1e-4);
}

TEST(PlaneProjection, RefusesWhatIsNoMapOfTwoAxes) {
    EXPECT_THAT([] { plane_projection("EPSG:4978"); },
                ThrowsMessage<InputError>(
                    AllOf(HasSubstr("the projection 'EPSG:4978': is not a coordinate reference "
                                    "system"),
                          HasSubstr("expected a projected or geographic coordinate reference "
                                    "system that PROJ knows"))));
    for (const auto* crs : {"EPSG:999999", "the moon", "+proj=none", ""}) {
        EXPECT_THAT([&] { plane_projection(crs); },
                    ThrowsMessage<InputError>(HasSubstr("the projection '" + std::string{crs})));
    }
}

// ---------------------------------------------------------------------------------- the frame

TEST(ProjectedFrame, HasTheConvergenceOfTransverseMercator) {
    const auto utm33 = plane_projection("EPSG:32633"); // its middle meridian is 15 degrees east
    for (const double lon_deg : {12.5, 15.0, 17.0}) {
        const auto frame = fitted_frame(
            {lon_deg - 0.01, 47.99, lon_deg + 0.01, 48.01}, {0, 0, 1000, 1000}, utm33.get());
        // J. P. Snyder, USGS Professional Paper 1395, eq. 8-9 of the sphere; grid north lies
        // clockwise of north where the map is east of the meridian.
        const double convergence_rad =
            std::atan(std::tan((lon_deg - 15) * rad_per_deg) * std::sin(48 * rad_per_deg));
        EXPECT_NEAR(north_rad(frame, {500, 500}), -convergence_rad, 2e-4) << lon_deg;
    }
    EXPECT_EQ(north_rad(fitted_frame({16, 48, 17, 49}, {0, 0, 100, 100}), {50, 50}), 0);
}

TEST(ProjectedFrame, KnowsHowMuchGroundAPixelShows) {
    const auto utm33 = plane_projection("EPSG:32633");
    const auto frame = fitted_frame({14.9, 47.9, 15.1, 48.1}, {0, 0, 1000, 1000}, utm33.get());
    // On the middle meridian the scale is 0.9996.
    EXPECT_NEAR(metres_per_px(frame, 500), plane_position(frame).per_px / 0.9996, 1e-3);
}

TEST(ProjectedFrame, ShowsAllOfItsBox) {
    const PixelBox room{10, 20, 910, 620};
    for (const auto* crs : {"EPSG:3035", "EPSG:32633", "EPSG:4326", "+proj=robin"}) {
        const auto plane = plane_projection(crs);
        const GeoBox box{5, 45, 20, 60};
        const auto frame = fitted_frame(box, room, plane.get());
        for (double lon_deg = 5; lon_deg <= 20; lon_deg += 0.5) {
            for (const double lat_deg : {45.0, 50.0, 60.0}) {
                const auto at = to_pixel(frame, {lat_deg, lon_deg});
                EXPECT_GT(at.x, room.left - 0.5) << crs; // between the places that were looked at
                EXPECT_LT(at.x, room.right + 0.5) << crs;
                EXPECT_GT(at.y, room.top - 0.5) << crs;
                EXPECT_LT(at.y, room.bottom + 0.5) << crs;
            }
        }
    }
}

TEST(ProjectedFrame, ShowsAPoleWhereTheProjectionHasIt) {
    const auto arctic = plane_projection("EPSG:3413");
    const auto frame = fitted_frame({-180, 80, 180, 90}, {0, 0, 600, 600}, arctic.get());
    EXPECT_NEAR(to_pixel(frame, {90, 0}).x, 300, 1);
    EXPECT_NEAR(to_pixel(frame, {90, 0}).y, 300, 1);
    EXPECT_TRUE(std::isfinite(north_rad(frame, {300, 300})));
}

TEST(ProjectedFrame, GoesOnOverTheAntimeridian) {
    const auto fiji = plane_projection("EPSG:3460");
    for (const auto* plane : {static_cast<const PlaneProjection*>(nullptr), fiji.get()}) {
        const auto frame = fitted_frame({179, -17.5, 181, -16}, {0, 0, 1000, 1000}, plane);
        const double west = to_pixel(frame, {-16.8, 179.5}).x;
        const double east = to_pixel(frame, {-16.8, 180.5}).x;
        EXPECT_GT(west, 0);
        EXPECT_GT(east, west + 100);
        EXPECT_LT(east, 1000);
    }
}

TEST(ProjectedFrame, RefusesWhatTheProjectionCannotShow) {
    const auto globe = plane_projection("+proj=ortho +lat_0=0 +lon_0=0");
    EXPECT_THAT(
        [&] {
            fitted_frame({170, 0, 175, 5}, {0, 0, 100, 100}, globe.get());
        },
        ThrowsMessage<InputError>(
            "the projection '+proj=ortho +lat_0=0 +lon_0=0' cannot show 0.00000,170.00000 "
            "(latitude, longitude), expected a box within its reach"));
}

TEST(ProjectedFrame, BendsLongLinesAsTheProjectionDoes) {
    const auto europe = plane_projection("EPSG:3035");
    const auto frame = fitted_frame({0, 50, 20, 55}, {0, 0, 1000, 1000}, europe.get());
    const std::vector<GeoPoint> parallel{{52, 1}, {52, 19}};
    const auto curve = bent(frame, parallel);
    EXPECT_GT(curve.size(), 8U);
    for (std::size_t i = 1; i < curve.size(); ++i) {
        const auto a = to_pixel(frame, curve[i - 1]);
        const auto b = to_pixel(frame, curve[i]);
        const auto m = to_pixel(frame, between(curve[i - 1], curve[i], 0.5));
        EXPECT_LE(std::hypot(m.x - (a.x + b.x) / 2, m.y - (a.y + b.y) / 2), 0.25);
    }
    EXPECT_THAT(bent(frame, {{52, 10}, {52.001, 10.001}}), SizeIs(2)); // too short to bend
    EXPECT_THAT(bent(fitted_frame({0, 50, 20, 55}, {0, 0, 10, 10}), parallel), SizeIs(2));
}

// ------------------------------------------------------------------------------- the picture

MapScene bare_scene(const GeoBox& box, const GeoPoint& middle) {
    MapLine dot; // 2 m of road: a round spot of its width
    dot.line = {{middle.lat_deg - 1e-5, middle.lon_deg}, {middle.lat_deg + 1e-5, middle.lon_deg}};
    dot.iri_class = 0;
    MapScene scene;
    scene.box = box;
    scene.lines = {dot};
    scene.scale_bar = false;
    scene.to_the_edge = true;
    return scene;
}

/// The middle of all that is not ground.
PixelPoint spot_in(const Image& image) {
    const auto* const rgb = image.rgb.data();
    double weight = 0;
    PixelPoint sum;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const auto* pixel = rgb + (std::size_t(y) * image.width + std::size_t(x)) * 3;
            const double ink = std::abs(int(pixel[1]) - int(rgb[1])); // from the corner's colour
            weight += ink;
            sum.x += ink * (x + 0.5);
            sum.y += ink * (y + 0.5);
        }
    }
    return {sum.x / weight, sum.y / weight};
}

TEST(ProjectedMap, HasARoadWhereItsPlaceSaysWithinHalfAPixel) {
    const GeoBox box{17.9, 59.2, 18.2, 59.4};
    const GeoPoint road{59.27, 18.13};
    const MapStyle style{.legend = false};
    for (const auto* crs : {"EPSG:3857", "EPSG:3006", "EPSG:4326", "EPSG:3413"}) {
        auto scene = bare_scene(box, road);
        const auto plane = plane_projection(crs);
        scene.projection = crs == std::string{"EPSG:3857"} ? nullptr : plane;
        const auto place = MapPlan(scene, style, {800, 600}).place();
        const auto spot = spot_in(render_map(scene, style, {800, 600}));
        const auto expected = plane->to_plane(road).value();
        EXPECT_NEAR((expected.x - place.left) / place.per_px, spot.x, 0.5) << crs;
        EXPECT_NEAR((place.top - expected.y) / place.per_px, spot.y, 0.5) << crs;
    }
}

TEST(ProjectedMap, IsFilledByItsBoxWhereItIsBare) {
    const GeoBox box{17.9, 59.2, 18.2, 59.4};
    const auto scene = bare_scene(box, {59.3, 18});
    const auto extent = plane_extent(box, nullptr);
    const int width = 900;
    const int height = int(std::lround(width * extent.height_rad / extent.width_rad));
    const auto place = MapPlan(scene, {.legend = false}, {width, height}).place();
    const auto corner = plane_projection("EPSG:3857")->to_plane({59.4, 17.9}).value();
    EXPECT_NEAR(place.left, corner.x, 0.5 * place.per_px);
    EXPECT_NEAR(place.top, corner.y, 0.5 * place.per_px);
}

} // namespace
} // namespace macadam::testing
