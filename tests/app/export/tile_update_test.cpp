// Tiles after a change, made from those before it: the same as if all were made anew.

#include "app/serve/live/tile_maker.hpp"
#include "app/tiles/tile_pyramid.hpp"
#include "app/tiles/tile_source.hpp"
#include "mapping/background/background.hpp"
#include "storage/store/put_background.hpp"
#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"
#include "support/roads/tile_town.hpp"
#include "support/roads/town.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace macadam::testing {
namespace {

using Tiles = std::map<TileId, std::string>;

const ClassTable& fhwa = *class_table("fhwa");
constexpr std::size_t streets = 120;

/// Ground that differs from tile to tile, and is missing in some.
std::string ground_of(const TileId& tile) {
    return (tile.x + tile.y) % 3 == 0 ? "" : "ground " + std::to_string(tile.x * 31 + tile.y);
}

std::unique_ptr<TileSource> source_of(const std::vector<TileSegment>& segments) {
    auto source = std::make_unique<TileSource>(test_folder() / "tiles");
    tile_town(source->words, streets); // the same numbers of words each time
    for (const auto& segment : segments) {
        add(*source, segment);
    }
    source->segments.settle();
    source->background = ground_of;
    return source;
}

std::vector<TileId> changed_tiles(const TileSource& before, const TileSource& after) {
    std::set<TileId> tiles;
    for (const auto* const source : {&before, &after}) {
        for (const auto& tile : source->segments.tiles()) {
            if (before.segments.read(tile) != after.segments.read(tile)) {
                tiles.insert(tile);
            }
        }
    }
    return {tiles.begin(), tiles.end()};
}

Tiles all_tiles(const TileSource& source, const TilePlan& plan) {
    Tiles tiles;
    make_vector_tiles(source,
                      fhwa,
                      plan,
                      [&](const TileId& tile, std::string_view bytes) { tiles[tile] = bytes; },
                      {});
    return tiles;
}

/// Changes the values of a street, or takes some of it away.
void change(std::vector<TileSegment>& segments, std::mt19937& random) {
    const auto street = static_cast<std::int64_t>(1 + random() % streets);
    const bool goes = random() % 3 == 0;
    std::erase_if(segments, [&](const TileSegment& each) {
        return goes && each.state.segment.way_id == street && random() % 4 != 0;
    });
    for (auto& each : segments) {
        if (each.state.segment.way_id == street) {
            each.state.iri_um = static_cast<IriUm>(700 + random() % 3000);
            ++each.state.passes;
        }
    }
}

TEST(TileUpdate, MakesTheTilesThatAFullMakeMakesAndFewerOfThem) {
    TilePlan plan{.min_zoom = 4, .max_zoom = 15, .jobs = 2};
    for (const std::uint64_t max_bytes : {300'000, 1500}) { // of the latter, many are coarsened
        plan.max_bytes = max_bytes;
        std::mt19937 random{7};
        TileWords words;
        const auto town = tile_town(words, streets);
        auto segments = town;
        TilePyramid pyramid{fhwa, plan, test_folder() / "parts"};
        Tiles tiles;
        std::size_t put = 0;
        const auto take = [&](const TileId& tile, std::string_view bytes) {
            ++put;
            tiles.erase(tile);
            if (!bytes.empty()) {
                tiles.emplace(tile, bytes);
            }
        };
        auto source = source_of(segments);
        pyramid.update(*source, source->segments.tiles(), take, {});
        const auto put_at_first = put;
        ASSERT_TRUE(tiles == all_tiles(*source, plan));
        ASSERT_GT(tiles.size(), 500U);
        for (int round = 0; round < 8; ++round) {
            if (round == 6) { // a far street alone remains, and then all come back
                std::erase_if(segments, [](const TileSegment& each) {
                    return each.state.segment.way_id != 5;
                });
            } else if (round == 7) {
                segments = town;
            } else {
                change(segments, random);
            }
            auto next = source_of(segments);
            put = 0;
            pyramid.update(*next, changed_tiles(*source, *next), take, {});
            ASSERT_TRUE(tiles == all_tiles(*next, plan)) << "round " << round;
            if (round < 6) {
                EXPECT_LT(put, put_at_first / 2) << "round " << round;
            }
            source = std::move(next);
        }
    }
}

TEST(TileUpdate, PutsNothingWhenNothingHasChanged) {
    TileWords words;
    const auto source = source_of(tile_town(words, streets));
    TilePyramid pyramid{fhwa, {}, test_folder() / "parts"};
    std::size_t put = 0;
    const auto take = [&](const TileId& /*tile*/, std::string_view /*bytes*/) { ++put; };
    pyramid.update(*source, source->segments.tiles(), take, {});
    EXPECT_GT(put, 100U);
    put = 0;
    pyramid.update(*source, {}, take, {});
    EXPECT_EQ(put, 0U);
}

// -------------------------------------------------------------------------------- of a database

Tiles tiles_of(const TileSet& set) {
    Tiles tiles;
    if (set.count() == 0) {
        return tiles;
    }
    for (int zoom = TileSet::min_zoom; zoom <= TileSet::max_zoom; ++zoom) {
        const auto range = tiles_of(set.box(), zoom);
        for (auto x = range.first_x - std::min(range.first_x, 1U); x <= range.last_x + 1; ++x) {
            for (auto y = range.first_y - std::min(range.first_y, 1U); y <= range.last_y + 1; ++y) {
                const TileId tile{static_cast<std::uint8_t>(zoom), x, y};
                if (auto bytes = set.tile(tile)) {
                    tiles[tile] = *std::move(bytes);
                }
            }
        }
    }
    return tiles;
}

void expect_same(const TileSet& made, const TileSet& expected) {
    ASSERT_GT(made.count(), 0U);
    EXPECT_EQ(made.count(), expected.count());
    EXPECT_EQ(made.box().west_deg, expected.box().west_deg);
    EXPECT_EQ(made.box().south_deg, expected.box().south_deg);
    EXPECT_EQ(made.box().east_deg, expected.box().east_deg);
    EXPECT_EQ(made.box().north_deg, expected.box().north_deg);
    EXPECT_TRUE(tiles_of(made) == tiles_of(expected));
}

TEST(TileMaker, FollowsADatabaseAsTripsComeAndGo) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    TileMaker maker{folder / "tiles"};
    const auto made_anew = [&] { return TileMaker{folder / "tiles"}.make(store, "new", {}); };
    EXPECT_EQ(maker.make(store, "0", {})->count(), 0U);
    for (int number = 0; number < 6; ++number) {
        auto passes = passes_of(number);
        passes.resize(passes.size() / (1 + static_cast<std::size_t>(number) % 3)); // of some roads
        ASSERT_TRUE(add_trip(store, trip_record(number), passes));
        store.importer.refresh();
        expect_same(*maker.make(store, std::to_string(number), {}), *made_anew());
    }
    const auto before = maker.make(store, "same", {});
    EXPECT_EQ(maker.made(), 0U);
    ForgetRequest request;
    request.vehicles = {"car-1"};
    store.maintenance.forget(request);
    const auto after = maker.make(store, "less", {});
    expect_same(*after, *made_anew());
    EXPECT_GT(maker.made(), 0U);
    EXPECT_FALSE(tiles_of(*before) == tiles_of(*after)); // and the earlier set still answers
}

TEST(TileMaker, MakesAfterForgottenTripsOnlyTheTilesThatShowedThem) {
    const auto folder = test_folder();
    const auto roads = made_up_town(30);
    auto store = RoadStore::create(folder / "a.gpkg", roads, {});
    const auto keys = keys_of(roads);
    ASSERT_GT(keys.size(), 2000U);
    const auto import_drive = [&](int number, std::size_t from, std::size_t past) {
        auto pass = passes_of(number).front();
        std::vector<Pass> passes;
        for (auto i = from; i < past; ++i) {
            pass.segment = keys[i];
            pass.iri_um = static_cast<IriUm>(900 + 37 * i % 2000);
            passes.push_back(pass);
        }
        ASSERT_TRUE(add_trip(store, trip_record(number), passes));
        store.importer.refresh();
    };
    import_drive(0, 0, keys.size() - 100);
    import_drive(1, 700, 760);                       // over what is known
    import_drive(2, keys.size() - 100, keys.size()); // alone, to the end of the town
    TileMaker maker{folder / "tiles"};
    const auto all = maker.make(store, "all", {});
    for (const int number : {1, 2}) {
        ASSERT_TRUE(maker.can_update(store));
        ForgetRequest request;
        request.trips = {trip_record(number).trip_id};
        store.maintenance.forget(request);
        if (number == 2) { // its row is given to another trip
            import_drive(3, 100, 130);
        }
        ASSERT_TRUE(maker.can_update(store));
        expect_same(*maker.make(store, "less", {}),
                    *TileMaker{folder / "tiles"}.make(store, "new", {}));
        EXPECT_GT(maker.made(), 0U);
        EXPECT_LT(maker.made(), all->count()) << number;
    }
}

TEST(TileMaker, FollowsABackgroundThatComesLater) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 2);
    TileMaker maker{folder / "tiles"};
    const auto without = maker.make(store, "without", {});
    put_background(
        folder / "a.gpkg",
        background_box(small_country()),
        [](const BackgroundSink& sink) {
            const auto box = extent_of(small_country());
            sink.place({"Town", PlaceRank::town, {box.south_deg, box.west_deg}});
        },
        "town.osm");
    const auto with = maker.make(store, "with", {});
    expect_same(*with, *TileMaker{folder / "tiles"}.make(store, "new", {}));
    EXPECT_FALSE(tiles_of(*without) == tiles_of(*with));
    EXPECT_EQ(store.audit().back().detail, "town.osm");
}

} // namespace
} // namespace macadam::testing
