#include "app/tiles/tile_layers.hpp"

#include "mapping/background/background.hpp"
#include "storage/store/put_background.hpp"
#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> ids_of(const std::vector<TileLayer>& layers) {
    std::vector<std::string> ids;
    for (const auto& layer : layers) {
        ids.push_back(layer.id);
    }
    return ids;
}

TEST(TileLayers, AreThoseOfTheBackgroundBelowTheRoads) {
    const auto file = test_folder() / "a.gpkg";
    new_store(file);
    EXPECT_THAT(ids_of(tile_layers(StoreReader::open(file), {})), ElementsAre("roughness"));
    put_background(file, background_box(small_country()), [](const BackgroundSink& sink) {
        const auto box = extent_of(small_country());
        sink.place({"Town", PlaceRank::town, {box.south_deg, box.west_deg}});
    });
    const auto store = StoreReader::open(file);
    const auto layers = tile_layers(store, {.min_zoom = 6, .max_zoom = 16});
    EXPECT_THAT(
        ids_of(layers),
        ElementsAre("built_up", "green", "water", "buildings", "railways", "places", "roughness"));
    ASSERT_EQ(layers[5].fields.size(), 3U); // kind, name, rank
    EXPECT_EQ(layers[3].min_zoom, 14);
    EXPECT_THAT(ids_of(tile_layers(store, {.min_zoom = 6, .max_zoom = 8})),
                ElementsAre("built_up", "green", "water", "places", "roughness"));
    EXPECT_THAT(ids_of(tile_layers(store, {.min_zoom = 0, .max_zoom = 5})),
                ElementsAre("roughness"));
}

TEST(TileLayers, OfABackgroundReachAsFarAsAllRoads) {
    const auto file = test_folder() / "a.gpkg";
    new_store(file);
    const auto box = extent_of(small_country());
    const GeoBox measured{box.west_deg, box.south_deg, box.west_deg + 1e-4, box.south_deg + 1e-4};
    EXPECT_EQ(tile_bounds(StoreReader::open(file), measured).east_deg, measured.east_deg);
    put_background(file, background_box(small_country()), [&](const BackgroundSink& sink) {
        sink.place({"Town", PlaceRank::town, {box.south_deg, box.west_deg}});
    });
    EXPECT_NEAR(tile_bounds(StoreReader::open(file), measured).east_deg, box.east_deg, 1e-6);
}

} // namespace
} // namespace macadam::testing
