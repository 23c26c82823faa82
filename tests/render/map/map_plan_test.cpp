#include "render/map/map_plan.hpp"

#include "mapping/tiles/tile_grid.hpp"
#include "render/background/background_painter.hpp"
#include "render/scene/colour.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace macadam::testing {
namespace {

const GeoBox town{16, 48, 16.01, 48.006};
constexpr PictureSize size{700, 520};

MapScene words() {
    return {.box = town,
            .lines = {},
            .title = "Roads of a town",
            .subtitle = "May to June",
            .attribution = "© contributors",
            .class_km = {1, 2, 3}};
}

/// Streets from the west to the east, so dense that a legend hides some of them anywhere.
std::vector<MapLine> dense_streets() {
    std::vector<MapLine> lines;
    for (int i = 0; i <= 30; ++i) {
        MapLine line;
        const double lat_deg = 47.998 + 0.01 * i / 30;
        line.line = {{lat_deg, 15.99}, {lat_deg, 16.02}};
        line.iri_class = i % 3;
        lines.push_back(line);
    }
    return lines;
}

std::vector<MapLine> one_street() {
    MapLine line;
    line.line = {{48.003, 16.004}, {48.003, 16.006}};
    line.iri_class = 1;
    return {line};
}

bool is_within(const GeoBox& inner, const GeoBox& outer) {
    return outer.west_deg <= inner.west_deg && outer.south_deg <= inner.south_deg &&
           outer.east_deg >= inner.east_deg && outer.north_deg >= inner.north_deg;
}

std::vector<std::uint8_t> drawn(MapPlan& plan) {
    std::vector<std::uint8_t> rgb;
    plan.draw([&](std::span<const std::uint8_t> rows) {
        rgb.insert(rgb.end(), rows.begin(), rows.end());
    });
    return rgb;
}

} // namespace

TEST(MapPlan, NeedsTheRoadsOfItsWholePicture) {
    const MapPlan plan{words(), {}, size};
    const auto place = plan.place();
    const auto ground = plan.ground();
    EXPECT_TRUE(is_within(town, ground));
    // EPSG:3857 has 6,378,137 m to a radian of longitude.
    constexpr double deg_per_m = 180 / (3.14159265358979 * 6378137);
    EXPECT_LT(ground.west_deg, place.left * deg_per_m);
    EXPECT_GT(ground.east_deg, (place.left + size.width_px * place.per_px) * deg_per_m);
}

/// A tile around the town that is water alone.
BackgroundTile water_of(const MapPlan& plan) {
    const auto zoom = plan.background_level().zoom;
    const auto range = tiles_of(town, zoom);
    BackgroundTile tile{{zoom, range.first_x, range.first_y}, {}};
    append_piece(tile.pieces,
                 {BackgroundKind::water,
                  {{{0, 0},
                    {background_cells, 0},
                    {background_cells, background_cells},
                    {0, background_cells}}}});
    return tile;
}

std::size_t pixels_of(const std::vector<std::uint8_t>& rgb, std::uint32_t colour) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < rgb.size(); i += 3) {
        count +=
            (std::uint32_t{rgb[i]} << 16U | std::uint32_t{rgb[i + 1]} << 8U | rgb[i + 2]) == colour;
    }
    return count;
}

TEST(MapPlan, DrawsItsBackgroundBelowTheRoadsInEveryThemeAndInAnyBands) {
    for (const auto theme :
         {MapStyle::Theme::light, MapStyle::Theme::dark, MapStyle::Theme::print}) {
        MapStyle style;
        style.theme = theme;
        const auto picture = [&](int band_px, bool with_water) {
            MapPlan plan{words(), style, {size.width_px, size.height_px, band_px}};
            plan.set_roads(one_street());
            if (with_water) {
                plan.set_background({{water_of(plan)}, {}});
            }
            return drawn(plan);
        };
        const auto colour = background_colour(BackgroundKind::water, theme);
        const auto wet = picture(0, true);
        EXPECT_GT(pixels_of(wet, colour), 50'000U);
        EXPECT_EQ(pixels_of(picture(0, false), colour), 0U);
        EXPECT_EQ(picture(37, true), wet);
        const auto road = class_colours(style, 3)[1];
        EXPECT_GT(pixels_of(wet, road), 100U);
    }
}

TEST(MapPlan, NeedsRoadsFarAroundInAProjection) {
    auto projected = words();
    projected.projection = plane_projection("EPSG:31287");
    EXPECT_TRUE(
        is_within(MapPlan(words(), {}, size).ground(), MapPlan(projected, {}, size).ground()));
}

TEST(MapPlan, KeepsItsGroundOnceItHasItsRoads) {
    MapPlan plan{words(), {}, size};
    plan.set_roads(one_street());
    const auto ground = plan.ground();
    EXPECT_TRUE(is_within(town, ground));
    plan.set_roads(one_street());
    EXPECT_TRUE(is_within(plan.ground(), ground));
}

TEST(MapPlan, NeedsMoreGroundWhereTheLegendFindsNoCornerWithoutRoads) {
    MapPlan plan{words(), {}, size};
    const auto ground = plan.ground();
    plan.set_roads(dense_streets());
    EXPECT_FALSE(is_within(plan.ground(), ground));
}

TEST(MapPlan, DrawsLinesThatItGetsLaterLikeThoseOfItsScene) {
    for (const auto& lines : {one_street(), dense_streets()}) {
        auto scene = words();
        MapPlan plan{scene, {}, size};
        plan.set_roads(lines);
        scene.lines = lines;
        EXPECT_TRUE(drawn(plan) == render_map(scene, {}, {size.width_px, size.height_px}).rgb);
    }
}

} // namespace macadam::testing
