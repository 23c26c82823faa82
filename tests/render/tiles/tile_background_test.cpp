// Picture tiles with water, green, buildings and names of places under and beside the roads.

#include "render/tiles/tile_background.hpp"

#include "mapping/background/background_tiling.hpp"
#include "render/background/background_painter.hpp"
#include "render/scene/colour.hpp"
#include "render/tiles/tile_painter.hpp"
#include "tile_scene.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

constexpr int tile_px = 128;
constexpr int across = 5;

TileId first_tile(int zoom) {
    const auto side = 1U << static_cast<unsigned>(zoom);
    return {static_cast<std::uint8_t>(zoom), side / 2 + side / 23, side / 3 + side / 57};
}

/// Pieces of lakes, woods, buildings, rivers and railways at random over a window and around it.
std::map<TileId, BackgroundTile> country(const WorldWindow& window) {
    const auto frame = world_frame(window.scale);
    const auto left = static_cast<double>(window.left_px), top = static_cast<double>(window.top_px);
    const double side = window.side_px;
    std::mt19937 random{17};
    const auto in = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random() % 10'000) / 10'000;
    };
    const auto north_west = to_geo(frame, {left - side, top - side});
    const auto south_east = to_geo(frame, {left + 2 * side, top + 2 * side});
    const GeoBox box{
        north_west.lon_deg, south_east.lat_deg, south_east.lon_deg, north_west.lat_deg};
    std::map<TileId, BackgroundTile> tiles;
    BackgroundTiling tiling{[&](const TileId& tile, std::string_view pieces) {
        tiles[tile].tile = tile;
        tiles[tile].pieces += pieces;
    }};
    for (int i = 0; i < 120; ++i) {
        const auto kind = static_cast<BackgroundKind>(random() % background_kinds);
        const double x = left + in(-0.3, 1.3) * side, y = top + in(-0.3, 1.3) * side;
        const double radius = in(4, is_line_kind(kind) ? 300 : 120);
        std::vector<PackedPoint> path;
        for (int k = 0; k < 9; ++k) {
            const double angle = 0.698 * k, far = radius * in(0.5, 1);
            path.push_back(
                packed(to_geo(frame, {x + far * std::cos(angle), y + far * std::sin(angle)})));
        }
        BackgroundFeature feature{kind, {}};
        feature.paths.push_back(std::move(path));
        tiling.add(feature, box);
    }
    tiling.finish();
    return tiles;
}

/// What a window needs of a background.
TileBackground background_for(const WorldWindow& window,
                              const std::map<TileId, BackgroundTile>& tiles,
                              const std::vector<PlaceName>& places) {
    const int zoom = tile_background_level(window.scale).zoom;
    const auto scale = std::exp2(window.scale.zoom - zoom) * window.scale.tile_px; // px of a tile
    const auto tile_at = [&](double px) { return static_cast<std::uint32_t>(px / scale); };
    const auto left = static_cast<double>(window.left_px), top = static_cast<double>(window.top_px);
    TileBackground background;
    for (const auto& [id, tile] : tiles) {
        if (id.zoom == zoom && id.x >= tile_at(left - background_reach_px) &&
            id.x <= tile_at(left + window.side_px + background_reach_px) &&
            id.y >= tile_at(top - background_reach_px) &&
            id.y <= tile_at(top + window.side_px + background_reach_px)) {
            background.tiles.push_back(tile);
        }
    }
    background.places = places;
    return background;
}

std::uint32_t pixel(const Image& image, int x, int y) {
    const auto* rgb = image.rgb.data() + (std::size_t(y) * image.width + std::size_t(x)) * 3;
    return std::uint32_t(rgb[0]) << 16 | std::uint32_t(rgb[1]) << 8 | rgb[2];
}

TEST(TileBackground, GivesTilesThatAreThePartsOfOneLargePicture) {
    for (const int zoom : {9, 12, 14, 16}) {
        const auto theme = zoom % 8 == 0 ? MapStyle::Theme::dark : MapStyle::Theme::light;
        MapStyle style;
        style.theme = theme;
        const auto first = first_tile(zoom);
        const auto window = window_of(first, tile_px, across);
        const auto tiles = country(window);
        const auto lines = town_in(window, 90);
        const auto at = [&](double x, double y) {
            return to_geo(
                world_frame(window.scale),
                {static_cast<double>(window.left_px) + x, static_cast<double>(window.top_px) + y});
        };
        const std::vector<PlaceName> places{
            {.name = "Weststadt", .rank = PlaceRank::city, .position = at(130, 250)},
            {.name = "Mitte", .rank = PlaceRank::town, .position = at(320, 330)}};
        const auto whole_background = background_for(window, tiles, places);
        ASSERT_FALSE(whole_background.tiles.empty());
        const auto whole =
            TilePainter{{style, tile_px, across}}.draw(first, lines, &whole_background);
        TilePainter painter{{style, tile_px, 1}};
        std::size_t different = 0, water = 0;
        for (int i = 0; i < across * across; ++i) {
            const int left = i % across, top = i / across;
            const TileId tile{first.zoom,
                              first.x + static_cast<std::uint32_t>(left),
                              first.y + static_cast<std::uint32_t>(top)};
            const auto own = background_for(window_of(tile, tile_px, 1), tiles, places);
            const auto image = painter.draw(tile, lines, &own);
            for (int k = 0; k < tile_px * tile_px; ++k) {
                const int x = k % tile_px, y = k / tile_px;
                const auto here = pixel(image, x, y);
                different += here != pixel(whole, left * tile_px + x, top * tile_px + y);
                water += here == background_colour(BackgroundKind::water, theme);
            }
        }
        EXPECT_EQ(different, 0U) << zoom;
        EXPECT_GT(water, 1000U) << zoom;
    }
}

TEST(TileBackground, HasBuildingsFromZoom16On) {
    BackgroundTile tile{{14, 8629, 5747}, {}};
    BackgroundPiece house{BackgroundKind::building, {}};
    house.paths.push_back({{0, 0}, {8192, 0}, {8192, 8192}, {0, 8192}});
    append_piece(tile.pieces, house);
    const TileBackground background{{tile}, {}};
    const auto ground = palette(MapStyle{}).ground;
    const auto building = background_colour(BackgroundKind::building, MapStyle::Theme::light);
    TilePainter painter{{{}, 256, 1}};
    const auto middle_of = [&](const TileId& id) {
        return pixel(painter.draw(id, {}, &background), 128, 128);
    };
    EXPECT_EQ(middle_of({15, 8629 * 2, 5747 * 2}), ground);
    EXPECT_EQ(middle_of({16, 8629 * 4, 5747 * 4}), building);
}

TEST(TileBackground, NamesPlacesFromTheZoomOfTheirRank) {
    const std::vector<PlaceName> places{
        {.name = "Vaduz", .rank = PlaceRank::city, .position = {47.14, 9.52}},
        {.name = "Ebenholz", .rank = PlaceRank::suburb, .position = {47.15, 9.51}}};
    EXPECT_EQ(tile_places(places, {5, 256}).size(), 0U);
    EXPECT_EQ(tile_places(places, {6, 256}).size(), 1U);
    EXPECT_EQ(tile_places(places, {12, 256}).size(), 1U);
    EXPECT_EQ(tile_places(places, {12, 512}).size(), 2U);
}

} // namespace
} // namespace macadam::testing
