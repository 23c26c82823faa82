#include "mapping/network/build_network.hpp"
#include "storage/store/road_store.hpp"

#include "estimator/common/error.hpp"
#include "mapping/conflation/network_conflation.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "support/files/files.hpp"
#include "support/roads/edited_network.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>

namespace macadam {
namespace {

using testing::add_trip;
using ::testing::HasSubstr;
using testing::refusal_of;
using testing::test_folder;

RoadNetwork with_edits(const std::function<void(testing::EditedNetwork&)>& edit) {
    auto network = testing::edited(copies_of_ways(testing::small_country()));
    edit(network);
    return build_network(testing::ways_of(network));
}

RoadStore filled_store(const std::filesystem::path& file) {
    auto store = testing::new_store(file);
    testing::import_trips(store, 5);
    return store;
}

NetworkUpdate update(RoadStore& store, const RoadNetwork& after, const Progress& progress = {}) {
    const auto before = store.roads();
    return store.maintenance.update_network(
        before, after, change_between(before, after), {"newer.osm.pbf", "© somebody"}, progress);
}

void expect_whole(const std::filesystem::path& file) {
    Database database{file, Database::Access::read};
    auto check = database.prepare("PRAGMA integrity_check");
    check.step();
    EXPECT_EQ(check.text(0), "ok");
    EXPECT_FALSE(database.prepare("PRAGMA foreign_key_check").step());
    EXPECT_EQ(database.number("SELECT rtreecheck('rtree_segment_geom') = 'ok'"), 1);
    EXPECT_EQ(database.number("SELECT count(*) FROM segment"),
              database.number("SELECT count(*) FROM rtree_segment_geom"));
    EXPECT_EQ(database.number("SELECT count(*) FROM segment_dirty"), 0);
}

TEST(NetworkUpdate, ToTheSameNetworkChangesNothing) {
    const auto file = test_folder() / "a.gpkg";
    auto store = filled_store(file);
    const auto digest = store.digest();
    const auto done = update(store, testing::small_country());
    EXPECT_FALSE(done.changed);
    EXPECT_EQ(done.generation, 1);
    EXPECT_EQ(done.passes_kept, store.info().passes);
    EXPECT_EQ(done.roads.lost, SegmentTotal{});
    EXPECT_EQ(done.roads.kept.segments, store.info().segments);
    EXPECT_EQ(store.digest(), digest);
}

TEST(NetworkUpdate, CarriesAWayToItsNewNumberAndBack) {
    const auto file = test_folder() / "a.gpkg";
    auto store = filled_store(file);
    const auto digest = store.digest();
    const auto passes = store.info().passes;
    const auto there =
        update(store, with_edits([](auto& network) { testing::renumber(network, 1, 100); }));
    EXPECT_TRUE(there.changed);
    EXPECT_EQ(there.generation, 2);
    EXPECT_EQ(there.passes_carried, passes);
    EXPECT_EQ(there.passes_lost, 0U);
    EXPECT_EQ(there.roads.lost.segments, 0U);
    EXPECT_GT(there.roads.renamed.segments, 0U);
    EXPECT_NE(store.digest(), digest);
    EXPECT_EQ(store.info().settings.network_source, "newer.osm.pbf");
    EXPECT_EQ(store.info().settings.attribution, "© somebody");
    expect_whole(file);

    EXPECT_EQ(update(store, testing::small_country()).generation, 3);
    EXPECT_EQ(store.digest(), digest);
    expect_whole(file);
}

TEST(NetworkUpdate, SplitsAWayAndMergesItAgain) {
    const auto file = test_folder() / "a.gpkg";
    auto store = filled_store(file);
    const auto digest = store.digest();
    const auto there =
        update(store, with_edits([](auto& network) { testing::split(network, 1, 1, 100); }));
    EXPECT_GT(there.roads.split.segments, 0U);
    EXPECT_EQ(there.passes_lost, 0U);
    expect_whole(file);
    update(store, testing::small_country());
    EXPECT_EQ(store.digest(), digest); // its junction stays, so its segments do
    expect_whole(file);
}

TEST(NetworkUpdate, ComesToWhatAStoreOfTheNewNetworkHolds) {
    const auto folder = test_folder();
    auto store = filled_store(folder / "a.gpkg");
    const auto renumbered = with_edits([](auto& network) { testing::renumber(network, 1, 100); });
    update(store, renumbered);

    auto fresh = RoadStore::create(folder / "b.gpkg", renumbered, testing::settings());
    for (int number = 0; number < 5; ++number) {
        auto passes = testing::passes_of(number);
        for (auto& pass : passes) {
            pass.segment.way_id = 100;
        }
        add_trip(fresh, testing::trip_record(number), passes);
    }
    fresh.importer.refresh();
    EXPECT_EQ(store.digest(), fresh.digest());
    EXPECT_EQ(store.network_hash(), fresh.network_hash());
    EXPECT_EQ(store.info().segments, fresh.info().segments);
    EXPECT_DOUBLE_EQ(store.info().network_km, fresh.info().network_km);
}

TEST(NetworkUpdate, KeepsTheOrderOfKeys) {
    auto store = filled_store(test_folder() / "a.gpkg");
    update(store, with_edits([](auto& network) {
               testing::split(network, 1, 1, -5);
               testing::reverse(network, 2);
           }));
    SegmentFilter all;
    all.with_state_only = false;
    auto boxed = all;
    boxed.box = GeoBox{-180, -90, 180, 90};
    for (const auto& filter : {all, boxed}) {
        std::vector<SegmentKey> keys;
        store.visit(filter,
                    [&](const SegmentRecord& record) { keys.push_back(record.segment.key); });
        EXPECT_EQ(keys.size(), store.info().segments);
        EXPECT_TRUE(std::ranges::is_sorted(keys));
    }
}

TEST(NetworkUpdate, LosesWhatIsGoneAndSaysSo) {
    const auto file = test_folder() / "a.gpkg";
    auto store = filled_store(file);
    const auto passes = store.info().passes;
    const auto done = update(store, with_edits([](auto& network) { testing::erase(network, 1); }));
    EXPECT_EQ(done.passes_lost, passes);
    EXPECT_EQ(store.info().passes, 0U);
    EXPECT_EQ(store.info().segments_with_passes, 0U);
    ASSERT_EQ(done.roads.lost_roads.size(), 1U);
    EXPECT_EQ(done.roads.lost_roads[0].name, "Rue de l'Épée 100%");
    EXPECT_NEAR(done.roads.lost_roads[0].length_m, done.roads.lost.length_m, 1e-6);
    expect_whole(file);
}

TEST(NetworkUpdate, CarriesTheDayFromWhichPassesCount) {
    const auto file = test_folder() / "a.gpkg";
    auto store = filled_store(file);
    {
        Database database{file, Database::Access::write};
        database.run("INSERT INTO valid_from SELECT fid, 5 FROM segment WHERE segment = '1+0003'");
    }
    update(store, with_edits([](auto& network) { testing::renumber(network, 1, 100); }));
    Database database{file, Database::Access::read};
    auto select = database.prepare("SELECT segment.segment, valid_from.from_ms FROM valid_from"
                                   " JOIN segment ON segment.fid = valid_from.segment");
    ASSERT_TRUE(select.step());
    EXPECT_EQ(select.text(0), "100+0003");
    EXPECT_EQ(select.integer(1), 5);
    EXPECT_FALSE(select.step());
}

ControlSection section_of(std::int64_t way_id, const std::string& name) {
    return {.name = name,
            .way_id = way_id,
            .forward = true,
            .from_m = 20,
            .to_m = 80,
            .iri_mm_per_m = 2,
            .sd_mm_per_m = 0.1,
            .utc_ms = std::nullopt};
}

TEST(NetworkUpdate, CarriesControlSectionsAndNamesThoseThatAreGone) {
    auto store = filled_store(test_folder() / "a.gpkg");
    const auto way = section_of(1, "long");
    const auto gone = section_of(3, "gone");
    store.maintenance.put_control_sections(std::array{way, gone});
    const auto done = update(store, with_edits([](auto& network) {
                                 testing::reverse(network, 1);
                                 testing::renumber(network, 1, 100);
                                 testing::erase(network, 3);
                             }));
    EXPECT_EQ(done.lost_sections, std::vector<std::string>{"gone"});
    const auto sections = store.control_sections();
    ASSERT_EQ(sections.size(), 1U);
    EXPECT_EQ(sections[0].way_id, 100);
    EXPECT_FALSE(sections[0].forward);
    // Drawn the other way round, 20 to 80 m of 200 m are 120 to 180 m.
    const double whole_m = way_at(testing::small_country(), 0).along_m.back();
    EXPECT_NEAR(sections[0].from_m, whole_m - 80, 0.01);
    EXPECT_NEAR(sections[0].to_m, whole_m - 20, 0.01);
}

TEST(NetworkUpdate, RefusesAMapOfAnotherArea) {
    auto store = filled_store(test_folder() / "a.gpkg");
    const auto digest = store.digest();
    const auto elsewhere = with_edits([](auto& network) {
        testing::nudge(network, [](std::int64_t, const GeoPoint& place) {
            return GeoPoint{place.lat_deg + 1, place.lon_deg};
        });
    });
    EXPECT_THAT(refusal_of([&] { update(store, elsewhere); }),
                HasSubstr("only 0.0 % of its roads are in 'newer.osm.pbf', expected a map of "
                          "the same area; the database is unchanged"));
    EXPECT_EQ(store.digest(), digest);
}

TEST(NetworkUpdate, LeavesTheStoreAsItWasWhenInterrupted) {
    const auto file = test_folder() / "a.gpkg";
    auto store = filled_store(file);
    const auto digest = store.digest();
    std::stop_source source;
    source.request_stop();
    EXPECT_THAT(refusal_of([&] {
                    update(store,
                           with_edits([](auto& network) { testing::renumber(network, 1, 100); }),
                           {.report = {}, .stop = source.get_token()});
                }),
                HasSubstr("a.gpkg: "));
    EXPECT_EQ(store.digest(), digest);
    expect_whole(file);
}

TEST(NetworkUpdate, LeavesReadersTheirMoment) {
    const auto file = test_folder() / "a.gpkg";
    auto store = filled_store(file);
    const auto reader = StoreReader::open(file);
    std::size_t seen = 0;
    bool updated = false;
    reader.visit({}, [&](const SegmentRecord& record) {
        if (!updated) {
            updated = true;
            update(store, with_edits([](auto& network) { testing::renumber(network, 1, 100); }));
        }
        EXPECT_EQ(record.segment.key.way_id, 1);
        ++seen;
    });
    EXPECT_EQ(seen, store.info().segments_with_passes);
    reader.visit({},
                 [](const SegmentRecord& record) { EXPECT_EQ(record.segment.key.way_id, 100); });
}

TEST(NetworkUpdate, RefusesTripsThatWereMatchedToTheRoadsOfBefore) {
    const auto file = test_folder() / "a.gpkg";
    auto store = filled_store(file);
    auto importer = RoadStore::open(file);
    update(store, with_edits([](auto& network) { testing::renumber(network, 1, 100); }));
    EXPECT_THAT(
        refusal_of([&] { add_trip(importer, testing::trip_record(9), testing::passes_of(9)); }),
        HasSubstr("its roads were updated in the meantime; nothing was written, run the "
                  "command again"));
}

} // namespace
} // namespace macadam
