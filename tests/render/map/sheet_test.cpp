#include "render/map/map_plan.hpp"
#include "render/map/sheet/legend.hpp"
#include "render/map/sheet/legend_placement.hpp"
#include "render/map/sheet_shape.hpp"
#include "render/scene/colour.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

namespace macadam::testing {
namespace {

using ::testing::Not;

constexpr PictureSize usual{.width_px = 1600, .height_px = 1200, .px_per_inch = 96};
constexpr double m_per_deg = 111'195;
constexpr double cos_lat = 0.669; // at 48 degrees

GeoPoint at(double east_m, double north_m) {
    return {48 + north_m / m_per_deg, 16 + east_m / m_per_deg / cos_lat};
}

MapLine street(const GeoPoint& from, const GeoPoint& to) {
    MapLine line;
    line.line = {from, to};
    line.iri_class = 1;
    return line;
}

struct Shape {
    std::string name;
    MapScene scene;
};

/// A scene with title and attribution whose box has a width and a height.
MapScene sheet(double width_m, double height_m) {
    const auto south_west = at(-width_m / 2, -height_m / 2);
    const auto north_east = at(width_m / 2, height_m / 2);
    return {.box = {south_west.lon_deg, south_west.lat_deg, north_east.lon_deg, north_east.lat_deg},
            .lines = {},
            .title = "Road roughness",
            .subtitle = "May to June",
            .attribution = "© contributors",
            .class_km = {1, 2, 3}};
}

/// Streets all over the box.
Shape filled(const std::string& name, double width_m, double height_m) {
    std::mt19937 random{3};
    std::uniform_real_distribution<double> share{-0.5, 0.5};
    Shape shape{name, sheet(width_m, height_m)};
    for (int i = 0; i < 400; ++i) {
        const double east_m = share(random) * width_m;
        const double north_m = share(random) * height_m;
        shape.scene.lines.push_back(street(at(east_m, north_m), at(east_m + 40, north_m + 30)));
    }
    return shape;
}

Shape one_road() {
    Shape shape{"one road",
                sheet(8000, 2000)}; // with ground on both sides, as the program gives it
    shape.scene.lines.push_back(street(at(-4000, 0), at(4000, 100)));
    return shape;
}

Shape outline_of_a_country() {
    Shape shape{"outline of a country", sheet(12'000, 25'000)};
    for (int i = 0; i < 60; ++i) {
        const auto corner = [](int step) {
            const double angle = 2 * std::numbers::pi * step / 60;
            const double r = 1 - 0.15 * (step % 4);
            return at(6000 * r * std::cos(angle), 12'500 * r * std::sin(angle));
        };
        shape.scene.lines.push_back(street(corner(i), corner(i + 1)));
    }
    return shape;
}

Shape empty_region() {
    Shape shape{"empty region", sheet(3000, 2000)};
    auto line = street(at(-1500, 0), at(1500, 0));
    line.iri_class = -1;
    shape.scene.lines.push_back(line);
    return shape;
}

std::vector<Shape> shapes() {
    return {filled("thin tall", 5000, 20'000),
            filled("thin wide", 20'000, 5000),
            filled("square", 6000, 6000),
            filled("usual", 8000, 6000),
            one_road(),
            empty_region(),
            outline_of_a_country()};
}

/// Two towns of 4 km, 100 km apart, as the program gives them to the map: the larger as the main
/// one.
MapScene two_towns() {
    auto scene = sheet(4000, 4000);
    const auto south_west = at(98'000, 58'000);
    const auto north_east = at(102'000, 62'000);
    scene.insets.push_back(
        {{south_west.lon_deg, south_west.lat_deg, north_east.lon_deg, north_east.lat_deg},
         "Nebenstadt"});
    scene.place = "Hauptstadt";
    return scene;
}

} // namespace

TEST(Sheet, IsNeverEmptyForAThirdInAShapeThatSuitsTheDataOrHasRoomForDetails) {
    int seen = 0;
    int with_details = 0;
    for (const auto& [name, scene] : shapes()) {
        auto words = scene;
        words.lines.clear();
        const auto size = size_for(words, {}, usual, other_shapes(usual));
        MapPlan plan{words, {}, size};
        plan.set_roads(scene.lines);
        const bool has_details = plan.detail_room().has_value();
        with_details += has_details ? 1 : 0;
        EXPECT_TRUE(plan.empty_share() < 1.0 / 3 || has_details)
            << name << ": " << size.width_px << " x " << size.height_px;
        EXPECT_NEAR(double(size.width_px) * size.height_px, 1600 * 1200, 3000) << name;
        ++seen;
    }
    EXPECT_EQ(seen, 7);
    EXPECT_LE(with_details, 3); // the thin ones and the one road
}

TEST(Sheet, FillsTheGroundBesideThinDataWithDetailsAtARoundScale) {
    const auto thin = filled("thin tall", 5000, 20'000).scene;
    MapPlan plan{thin, {}, usual};
    const auto room = plan.detail_room();
    ASSERT_TRUE(room);
    EXPECT_GE(room->count, 1U);
    EXPECT_EQ(detail_scale(plan.scale()), room->scale_denominator);
    EXPECT_GT(plan.scale(), 2 * room->scale_denominator);

    auto scene = thin;
    const auto south_west = at(-room->width_m / 2, 0);
    const auto north_east = at(room->width_m / 2, room->height_m);
    scene.insets.push_back(
        {{south_west.lon_deg, south_west.lat_deg, north_east.lon_deg, north_east.lat_deg},
         "Mitte",
         room->scale_denominator});
    MapPlan sheet{scene, {}, usual};
    ASSERT_EQ(sheet.insets().size(), 1U);
    EXPECT_EQ(sheet.locator(), nullptr);
    EXPECT_EQ(sheet.insets()[0].scene().title, "A   Mitte");
    EXPECT_NEAR(sheet.insets()[0].scale(), room->scale_denominator, 1);
    EXPECT_LT(sheet.empty_share(), 1.0 / 3);
    EXPECT_FALSE(sheet.detail_room()); // it is full
}

TEST(Sheet, OfPaperIsFilledWithDetailsBelowASquareCity) {
    constexpr PictureSize a2{
        .width_px = 4961, .height_px = 7016, .px_per_inch = 300, .is_on_paper = true};
    const auto square = filled("square", 10'000, 10'000).scene;
    MapPlan plan{square, {}, a2};
    const auto room = plan.detail_room();
    ASSERT_TRUE(room); // of the sheet, 30 % would be empty
    EXPECT_EQ(room->count, 3U);
    // On A5 they would be smaller than 40 mm: the legend has a band of the page instead.
    constexpr PictureSize a5{
        .width_px = 1748, .height_px = 2480, .px_per_inch = 300, .is_on_paper = true};
    EXPECT_FALSE((MapPlan{square, {}, a5}.detail_room()));
}

TEST(Sheet, HasTheLegendInABandBelowASquareCityButNoColumnBesideIt) {
    auto square = sheet(10'000, 10'000);
    for (double north_m = -4000; north_m <= 4000; north_m += 500) { // all corners are free
        square.lines.push_back(street(at(-3000, north_m), at(3000, north_m)));
    }
    square.lines.push_back(street(at(-5000, 0), at(5000, 0)));
    const auto is_page = [&](const PictureSize& size, double x_share, double y_share) {
        MapPlan plan{square, {}, size};
        std::vector<std::uint8_t> rgb;
        plan.draw([&](auto rows) { rgb.insert(rgb.end(), rows.begin(), rows.end()); });
        const auto i = 3 * (std::size_t(y_share * size.height_px) * std::size_t(size.width_px) +
                            std::size_t(x_share * size.width_px));
        return rgb[i] == 0xff && rgb[i + 1] == 0xff && rgb[i + 2] == 0xff;
    };
    constexpr PictureSize portrait{.width_px = 700, .height_px = 1100, .px_per_inch = 96};
    EXPECT_TRUE(is_page(portrait, 0.99, 0.92));
    constexpr PictureSize landscape{.width_px = 1100, .height_px = 700, .px_per_inch = 96};
    EXPECT_FALSE(is_page(landscape, 0.99, 0.5));
}

TEST(Sheet, HasNoDetailsWhereTheDataFillsItOrIsLargeAlready) {
    EXPECT_FALSE((MapPlan{filled("usual", 8000, 6000).scene, {}, usual}.detail_room()));
    EXPECT_FALSE((MapPlan{sheet(100, 1000), {}, usual}.detail_room())); // 1:4,000
    EXPECT_EQ(detail_scale(6000), std::nullopt);
    EXPECT_EQ(detail_scale(6250), 2500);
    EXPECT_EQ(detail_scale(64'000), 25'000);
    EXPECT_EQ(detail_scale(1'000'000), 400'000);
}

TEST(Sheet, HasTheScaleThatIsAskedFor) {
    auto scene = filled("usual", 8000, 6000).scene;
    scene.scale_denominator = 25'000;
    for (const auto& size :
         {usual, PictureSize{.width_px = 3508, .height_px = 2480, .px_per_inch = 300}}) {
        const MapPlan plan{scene, {}, size};
        EXPECT_NEAR(plan.scale(), 25'000, 1);
    }
}

TEST(Sheet, HasAScaleOfTwoFiguresOnPaper) {
    const auto scene = filled("usual", 8000, 6000).scene;
    auto paper = usual;
    paper.is_on_paper = true;
    const double as_large_as_fits = MapPlan{scene, {}, usual}.scale();
    const double scale = MapPlan{scene, {}, paper}.scale();
    EXPECT_NEAR(scale, 1000 * std::round(scale / 1000), 1); // here of five digits
    EXPECT_GE(scale, as_large_as_fits - 1);
    EXPECT_LT(scale, 1.1 * as_large_as_fits);
}

TEST(Sheet, GivesTheLegendAStripWhereRoadsAreAllOverAndAround) {
    auto city = sheet(4000, 3000);
    for (double north_m = -4500; north_m <= 4500; north_m += 150) {
        city.lines.push_back(street(at(-6000, north_m), at(6000, north_m)));
    }
    MapPlan plan{city, {}, usual};
    std::vector<std::uint8_t> rgb;
    plan.draw([&](auto rows) { rgb.insert(rgb.end(), rows.begin(), rows.end()); });
    TypeSetter setter;
    const auto layout = layout_of(city, usual, setter);
    const auto legend = legend_of(city, {}, classes_of({}));
    EXPECT_TRUE(placement_of(city, legend, layout, setter).hides_roads);
    const auto strip = legend_strip(legend, layout, setter);
    const auto page = palette(MapStyle::Theme::light).page;
    const auto x = std::size_t(layout.map.right) - 20;
    for (const double y : {strip.map.bottom + 20, layout.map.bottom - 20}) {
        const auto i = 3 * (std::size_t(y) * 1600 + x);
        EXPECT_EQ(std::uint32_t{rgb[i]} << 16U | std::uint32_t{rgb[i + 1]} << 8U | rgb[i + 2],
                  page);
    }
}

TEST(Sheet, KeepsItsUsualShapeWhereThatSuitsTheData) {
    const auto size = size_for(sheet(8000, 6000), {}, usual, other_shapes(usual));
    EXPECT_EQ(size.width_px, 1600);
    EXPECT_EQ(size.height_px, 1200);
    EXPECT_EQ(size_for(sheet(1000, 9000), {}, usual, {}).width_px, 1600); // asked for
}

TEST(Sheet, IsHigherThanWideForSquareData) { // title and legend lie above and below
    const auto square = filled("square", 10'000, 10'000).scene;
    const auto size = size_for(square, {}, usual, other_shapes(usual));
    EXPECT_GT(size.height_px, size.width_px);
    EXPECT_LT((MapPlan{square, {}, size}.empty_share()), 0.25);
}

TEST(Sheet, BeginsTheBandBesideAThinMapWithTheLegend) {
    TypeSetter setter;
    const auto tall = filled("thin tall", 4000, 20'000).scene;
    const auto layout = layout_of(tall, usual, setter);
    const auto band = legend_band(tall, legend_of(tall, {}, classes_of({})), layout, setter);
    ASSERT_TRUE(band);
    EXPECT_GE(band->corner.x, band->map.right);
    EXPECT_LT(band->corner.y, layout.map.top + 30);
}

TEST(Sheet, PutsTheLegendOnFreeGroundRatherThanMakingTheMapSmaller) {
    TypeSetter setter;
    const auto tall = filled("thin tall", 4000, 20'000).scene;
    const auto layout = layout_of(tall, usual, setter);
    const auto placement = placement_of(tall, legend_of(tall, {}, classes_of({})), layout, setter);
    EXPECT_FALSE(placement.makes_map_smaller);
    EXPECT_FALSE(placement.hides_roads);
    EXPECT_EQ(placement.frame.centre.x, 800); // the map keeps the whole width
}

TEST(Sheet, PutsTheLegendAtAnEdgeWhereTheCornersHaveRoads) {
    TypeSetter setter;
    auto scene = sheet(8000, 6000);
    for (const double east_m : {-3500, 3500}) {
        for (const double north_m : {-2500, 2500}) {
            scene.lines.push_back(
                street(at(east_m - 400, north_m), at(east_m + 400, north_m + 200)));
        }
    }
    const auto layout = layout_of(scene, usual, setter);
    const auto placement =
        placement_of(scene, legend_of(scene, {}, classes_of({})), layout, setter);
    EXPECT_FALSE(placement.makes_map_smaller);
    EXPECT_FALSE(placement.hides_roads);
    EXPECT_GT(placement.corner.y, layout.map.top + 150);
}

TEST(Sheet, PutsAWideLegendWhereOnlyAFlatStripIsFree) {
    TypeSetter setter;
    const auto wide = filled("strip below", 8000, 4200).scene; // leaves 116 px above and below
    const auto layout = layout_of(wide, usual, setter);
    const auto legend = legend_of(wide, {}, classes_of({}));
    const auto placement = placement_of(wide, legend, layout, setter);
    EXPECT_GT(placement.card.columns, 1);
    const auto without = placement_of(wide, {}, layout, setter);
    EXPECT_EQ(placement.frame.px_per_rad, without.frame.px_per_rad); // no smaller map
}

TEST(Sheet, KeepsNumbersWithTheirUnitsWhereALineEnds) {
    TypeSetter setter;
    auto scene = sheet(8000, 6000);
    scene.title = scene.subtitle = scene.attribution =
        "From 12.3 km to 45.6 km of 789 km at 1.5 – 2.7 mm/m in 9 % of 10 km, or 11 % of 12 km";
    using ::testing::AnyOf;
    using ::testing::StartsWith;
    std::size_t lines = 0;
    for (int width_px = 300; width_px <= 900; width_px += 20) {
        const auto layout = layout_of(scene, {.width_px = width_px, .height_px = 1500}, setter);
        for (const auto& text : layout.texts) {
            EXPECT_THAT(
                text.text,
                Not(AnyOf(StartsWith("km"), StartsWith("mm"), StartsWith("%"), StartsWith("–"))))
                << width_px;
        }
        lines += layout.texts.size();
    }
    EXPECT_GT(lines, 31U * 3 + 31U); // so many lines end within these texts
}

TEST(Sheet, ShowsFarOffPartsAtScalesOfTheirOwnBesideALocator) {
    MapPlan plan{two_towns(), {}, usual};
    ASSERT_EQ(plan.insets().size(), 1U);
    auto& inset = plan.insets()[0];
    EXPECT_EQ(inset.scene().title, "Nebenstadt");
    EXPECT_TRUE(inset.scene().scale_bar);
    EXPECT_LT(inset.scale(), 100'000);
    EXPECT_LT(plan.scale(), 50'000); // the main town fills its map
    ASSERT_NE(plan.locator(), nullptr);
    EXPECT_GT(plan.locator()->scale(), 500'000);
    EXPECT_THAT(plan.locator()->scene().places, ::testing::SizeIs(2));
    EXPECT_LT(plan.empty_share(), 1.0 / 3);

    const auto ground = inset.ground();
    EXPECT_GT(ground.west_deg, at(60'000, 0).lon_deg); // its roads alone
    inset.set_roads({street(at(98'500, 60'000), at(101'500, 60'000))});
    plan.set_roads({street(at(-1500, 0), at(1500, 0))});
    const auto road = class_colours({}, 3)[1];
    std::vector<std::uint8_t> rgb;
    plan.draw([&](auto rows) { rgb.insert(rgb.end(), rows.begin(), rows.end()); });
    int left = 0;
    int right = 0;
    for (std::size_t i = 0; i < rgb.size(); i += 3) {
        const bool is_road =
            (std::uint32_t{rgb[i]} << 16U | std::uint32_t{rgb[i + 1]} << 8U | rgb[i + 2]) == road;
        (i / 3 % 1600 < 1120 ? left : right) += is_road ? 1 : 0;
    }
    EXPECT_GT(left, 500); // of the legend too
    EXPECT_GT(right, 500);
}

TEST(Sheet, IsOneMapWhereInsetsWouldBeTooSmall) {
    const MapPlan small{two_towns(), {}, {.width_px = 700, .height_px = 520}};
    EXPECT_GT(small.scale(), 100'000);
    EXPECT_TRUE(small.scene().insets.empty());
}

} // namespace macadam::testing
