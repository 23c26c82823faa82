#include "render/tiles/mvt_background.hpp"

#include "estimator/common/error.hpp"

#include <gmock/gmock.h>
#include <protozero/pbf_reader.hpp>
#include <protozero/varint.hpp>

#include <cmath>
#include <map>

namespace macadam {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;

/// Layers of a tile by name, with the doubled areas of their rings by the specification: positive
/// for outer rings, 0 for lines and points.
using Layers = std::map<std::string, std::vector<std::int64_t>>;

std::vector<std::int64_t> twice_areas(protozero::pbf_reader feature) {
    std::vector<std::int64_t> areas;
    while (feature.next(4)) {
        std::vector<std::pair<std::int64_t, std::int64_t>> path;
        std::int64_t x = 0, y = 0;
        const auto numbers = feature.get_packed_uint32();
        for (auto at = numbers.begin(); at != numbers.end();) {
            const auto command = *at++;
            if ((command & 7U) == 7) {
                std::int64_t twice = 0;
                for (std::size_t i = 0; i < path.size(); ++i) {
                    const auto& a = path[i];
                    const auto& b = path[(i + 1) % path.size()];
                    twice += a.first * b.second - b.first * a.second;
                }
                areas.back() = twice;
                continue;
            }
            for (auto count = command >> 3U; count > 0; --count) {
                x += protozero::decode_zigzag32(*at++);
                y += protozero::decode_zigzag32(*at++);
                if ((command & 7U) == 1) {
                    path.clear();
                    areas.push_back(0);
                }
                EXPECT_TRUE(x >= -64 && x <= 4160 && y >= -64 && y <= 4160) << x << ' ' << y;
                path.emplace_back(x, y);
            }
        }
    }
    return areas;
}

Layers layers_in(const std::string& bytes) {
    Layers layers;
    protozero::pbf_reader tile{bytes};
    while (tile.next(3)) {
        const auto layer = tile.get_message();
        auto head = layer;
        EXPECT_TRUE(head.next(1));
        auto& areas = layers[head.get_string()];
        auto features = layer;
        while (features.next(2)) {
            const auto more = twice_areas(features.get_message());
            areas.insert(areas.end(), more.begin(), more.end());
        }
    }
    return layers;
}

std::string packed_pieces(const std::vector<BackgroundPiece>& pieces) {
    std::string bytes;
    for (const auto& piece : pieces) {
        append_piece(bytes, piece);
    }
    return bytes;
}

/// A lake over the whole tile with an island in its middle, and a railway through both.
BackgroundTile lake(const TileId& tile) {
    return {tile,
            packed_pieces({{BackgroundKind::water,
                            {{{0, 0}, {8192, 0}, {8192, 8192}, {0, 8192}},
                             {{2048, 2048}, {2048, 6144}, {6144, 6144}, {6144, 2048}}}},
                           {BackgroundKind::railway, {{{0, 4096}, {8192, 4096}}}}})};
}

constexpr std::int64_t whole_tile = std::int64_t{2} * 4096 * 4096;
constexpr TileId middle{14, 8629, 5747};

TEST(MvtBackground, HasALayerForEachGroupOfKindsWithRingsAsTheSpecificationTurnsThem) {
    const std::vector tiles{lake(middle)};
    EXPECT_THAT(layers_in(background_layers_of(middle, tiles, {})),
                ElementsAre(Pair("railways", ElementsAre(0)),
                            Pair("water", ElementsAre(whole_tile, -whole_tile / 4))));
}

TEST(MvtBackground, OfALargerZoomIsTheQuarterOfItsTileWithABuffer) {
    const std::vector tiles{lake(middle)};
    const TileId quarter{15, 2 * middle.x + 1, 2 * middle.y};
    const auto layers = layers_in(background_layers_of(quarter, tiles, {}));
    constexpr std::int64_t side = 4096 + 64, of_island = 2048 + 64;
    EXPECT_THAT(layers.at("water"),
                ElementsAre(2 * (side * side - of_island * of_island))); // around the island
    const TileId within{17, 8 * middle.x + 3, 8 * middle.y + 3};         // in the island
    EXPECT_FALSE(layers_in(background_layers_of(within, tiles, {})).contains("water"));
}

TEST(MvtBackground, GoesOnOverTheTilesEdgesAsFarAsItsBuffer) {
    const TileId east{14, middle.x + 1, middle.y}, far{14, middle.x + 2, middle.y};
    const std::vector tiles{lake(middle), lake(east), lake(far)};
    const auto layers = layers_in(background_layers_of(middle, tiles, {}));
    EXPECT_THAT(layers.at("water"),
                ElementsAre(whole_tile, -whole_tile / 4, std::int64_t{2} * 64 * 4096));
    EXPECT_THAT(layers.at("railways"), SizeIs(2));
}

TEST(MvtBackground, OfASmallerZoomJoinsTheTilesInIt) {
    const TileId whole{12, 2157, 1436};
    EXPECT_EQ(background_level_of_zoom(whole.zoom).zoom, 11);
    const TileId small{7, 67, 44};
    EXPECT_EQ(background_level_of_zoom(small.zoom).zoom, 8);
    const std::vector tiles{lake({8, 134, 88}), lake({8, 135, 89})};
    const auto layers = layers_in(background_layers_of(small, tiles, {}));
    EXPECT_THAT(layers.at("water"),
                ElementsAre(whole_tile / 4, -whole_tile / 16, whole_tile / 4, -whole_tile / 16));
    EXPECT_FALSE(layers.contains("railways")); // from zoom 9
}

TEST(MvtBackground, NamesThePlacesInATileFromTheZoomOfTheirRank) {
    const auto at = geo_point({middle.x + 0.25, middle.y + 0.75}, middle.zoom);
    const std::vector<PlaceName> places{{"Vaduz", PlaceRank::town, at},
                                        {"Afar", PlaceRank::city, {at.lat_deg + 1, at.lon_deg}}};
    EXPECT_THAT(layers_in(background_layers_of(middle, {}, places)).at("places"), SizeIs(1));
    const TileId above{7, middle.x >> 7U, middle.y >> 7U};
    const std::span first{places.data(), 1};
    EXPECT_THAT(layers_in(background_layers_of(above, {}, first)), IsEmpty());
}

TEST(MvtBackground, BelowItsSmallestZoomThereIsNone) {
    const std::vector tiles{lake({8, 134, 88})};
    EXPECT_EQ(background_layers_of({5, 16, 11}, tiles, {}), "");
}

TEST(MvtBackground, OfAModifiedDatabaseIsRefused) {
    const std::vector<BackgroundTile> tiles{{middle, "\x63"}};
    EXPECT_THROW(background_layers_of(middle, tiles, {}), InputError);
}

} // namespace
} // namespace macadam
