// Potholes and other events in a database: kept, fused, forgotten, moved, published, handed on.

#include "mapping/conflation/network_conflation.hpp"
#include "mapping/network/build_network.hpp"
#include "storage/exports/event_export.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/road_store.hpp"
#include "storage/store/upgrade/store_upgrade.hpp"
#include "support/files/files.hpp"
#include "support/roads/edited_network.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

PassEvent pothole(const SegmentKey& segment, std::int64_t at_mm) {
    return {.segment = segment,
            .occurrence = 0,
            .kind = EventKind::pothole,
            .track = WheelTrack::unknown,
            .at_mm = at_mm,
            .place_sd_mm = 1000,
            .size_um = 30'000,
            .sd_um = 9'500,
            .length_mm = 750};
}

/// What trip `number` reports: a pothole at 45 m forward, one at 130 m backward, and a false one.
std::vector<PassEvent> events_of(int number) {
    return {pothole({1, true, 2}, 45'000 + 100 * (number % 3)),
            pothole({1, false, 6}, 130'000),
            pothole({1, true, 8}, 161'000 + 4'000 * (number % 4))};
}

void add(RoadStore& store, int number) {
    add_trip(store, trip_record(number), passes_of(number), {}, events_of(number));
}

RoadStore store_of(const std::filesystem::path& file, const std::vector<int>& trips) {
    auto store = new_store(file);
    for (const int number : trips) {
        add(store, number);
    }
    store.importer.refresh();
    return store;
}

TEST(StoreEvents, AreFusedOverPassesWithTheirPlaceAndRoad) {
    const auto store = store_of(test_folder() / "a.gpkg", {0, 1, 2});
    const auto events = store.events({});
    ASSERT_THAT(events, SizeIs(2));
    const auto& [event, at, name, highway] = events[0];
    EXPECT_EQ(event.segment, (SegmentKey{1, true, 2}));
    EXPECT_EQ(event.at_mm, 45'100);
    EXPECT_EQ(event.passes, 3);
    EXPECT_EQ(event.passes_over, 3);
    EXPECT_EQ(event.vehicles, 3);
    EXPECT_TRUE(event.first_seen_ms && event.last_seen_ms);
    EXPECT_EQ(name, "Rue de l'Épée 100%");
    EXPECT_EQ(highway, "residential");
    EXPECT_EQ(events[1].event.segment, (SegmentKey{1, false, 6}));

    SegmentFilter key;
    key.key = SegmentKey{1, true, 2};
    key.with_state_only = false;
    GeoPoint begin{}, end{};
    store.visit(key, [&](const SegmentRecord& record) {
        begin = record.segment.line.front();
        end = record.segment.line.back();
    });
    EXPECT_NEAR(distance_m(begin, at), 5.1, 0.05); // the segment begins at 40 m
    EXPECT_NEAR(distance_m(at, end), 14.9, 0.05);
}

TEST(StoreEvents, AreThoseOfTheFilter) {
    const auto store = store_of(test_folder() / "a.gpkg", {0, 1, 2});
    SegmentFilter filter;
    filter.key = SegmentKey{1, false, 6};
    EXPECT_THAT(store.events(filter), SizeIs(1));
    filter.key = SegmentKey{1, true, 3};
    EXPECT_THAT(store.events(filter), IsEmpty());
    filter = {};
    filter.way_id = 2;
    EXPECT_THAT(store.events(filter), IsEmpty());
}

/// Trip 3 is undated, trips are 100 days apart.
TEST(StoreEvents, OfAPeriodAreOfItsPassesOnly) {
    const auto store = store_of(test_folder() / "a.gpkg", {0, 1, 2, 3});
    SegmentFilter filter;
    filter.period = Period{*trip_record(1).t0_utc_ms, std::nullopt};
    const auto events = store.events(filter);
    ASSERT_THAT(events, SizeIs(2));
    EXPECT_EQ(events[0].event.passes, 2);
    EXPECT_EQ(events[0].event.passes_over, 2);
}

TEST(StoreEvents, CountOnlyPassesThatWereSearched) {
    auto store = store_of(test_folder() / "a.gpkg", {0, 1});
    for (int number = 4; number < 20; ++number) {
        add_trip(store, trip_record(number), passes_of(number)); // by the published filter
    }
    store.importer.refresh();
    const auto events = store.events({});
    ASSERT_THAT(events, SizeIs(2));
    EXPECT_EQ(events[0].event.passes_over, 2);
}

TEST(StoreEvents, EndWhenNewPassesFindTheRoadMended) {
    auto store = store_of(test_folder() / "a.gpkg", {0, 1});
    for (int number = 4; number < 9; ++number) {
        add_trip(store, trip_record(number), passes_of(number), {}, std::vector<PassEvent>{});
    }
    store.importer.refresh();
    EXPECT_THAT(store.events({}), IsEmpty());
}

TEST(StoreEvents, BeforeTheStartDateDoNotCount) {
    auto store = store_of(test_folder() / "a.gpkg", {0, 1, 2});
    const std::vector segments{SegmentKey{1, true, 2}};
    store.maintenance.set_valid_from(segments, *trip_record(2).t0_utc_ms - 1, "resurfaced");
    EXPECT_THAT(store.events({}), SizeIs(1));
}

TEST(StoreEvents, AreTheSameInAnyOrderOfImport) {
    const auto folder = test_folder();
    const auto a = store_of(folder / "a.gpkg", {0, 1, 2, 3});
    const auto b = store_of(folder / "b.gpkg", {3, 1, 0, 2});
    EXPECT_EQ(a.digest(), b.digest());
    const auto events_a = a.events({});
    const auto events_b = b.events({});
    ASSERT_EQ(events_a.size(), events_b.size());
    for (std::size_t i = 0; i < events_a.size(); ++i) {
        EXPECT_EQ(events_a[i].event.at_mm, events_b[i].event.at_mm);
        EXPECT_EQ(events_a[i].event.size_um, events_b[i].event.size_um);
    }
    auto without = new_store(folder / "c.gpkg");
    import_trips(without, 4);
    EXPECT_NE(without.digest(), a.digest());
}

TEST(StoreEvents, AreForgottenWithTheirTrips) {
    const auto folder = test_folder();
    auto store = store_of(folder / "a.gpkg", {0, 1, 2});
    store.maintenance.forget({.trips = {"trip-1"}, .vehicles = {}});
    EXPECT_EQ(store.digest(), store_of(folder / "b.gpkg", {0, 2}).digest());
    EXPECT_EQ(store.events({}).at(0).event.passes, 2);
    store.maintenance.forget({.trips = {"trip-2"}, .vehicles = {}});
    EXPECT_THAT(store.events({}), IsEmpty());
}

TEST(StoreEvents, AreReplacedWhenTheirTripsAreReprocessed) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 2); // not searched
    EXPECT_THAT(store.events({}), IsEmpty());
    for (const int number : {0, 1}) {
        stage_trip(store, trip_record(number), passes_of(number), {}, events_of(number));
    }
    store.maintenance.commit_staged("anew");
    EXPECT_EQ(store.digest(), store_of(folder / "b.gpkg", {0, 1}).digest());
    EXPECT_THAT(store.events({}), SizeIs(2));

    stage_trip(store, trip_record(0), passes_of(0), {}); // by the published filter
    store.maintenance.commit_staged("anew");
    EXPECT_THAT(store.events({}), IsEmpty());
}

RoadNetwork with_edits(const std::function<void(EditedNetwork&)>& edit) {
    auto network = edited(copies_of_ways(small_country()));
    edit(network);
    return build_network(ways_of(network));
}

void update(RoadStore& store, const RoadNetwork& after) {
    const auto before = store.roads();
    store.maintenance.update_network(before, after, change_between(before, after), {"newer", "©"});
}

TEST(StoreEvents, GoWithTheirRoadToANewerMap) {
    auto store = store_of(test_folder() / "a.gpkg", {0, 1, 2});
    const auto digest = store.digest();
    const auto at = store.events({}).at(0).at;
    update(store, with_edits([](auto& network) { renumber(network, 1, 100); }));
    auto events = store.events({});
    ASSERT_THAT(events, SizeIs(2));
    EXPECT_EQ(events[0].event.segment, (SegmentKey{100, true, 2}));
    EXPECT_LT(distance_m(events[0].at, at), 0.05);
    update(store, small_country());
    EXPECT_EQ(store.digest(), digest);

    update(store, with_edits([](auto& network) { split(network, 1, 1, 100); }));
    events = store.events({});
    ASSERT_THAT(events, SizeIs(2));
    EXPECT_LT(distance_m(events[0].at, at), 0.05);
    update(store, small_country());
    EXPECT_EQ(store.digest(), digest);
}

TEST(StoreEvents, OfADatabaseOfVersion3AreNoneUntilItIsReprocessed) {
    const auto file = test_folder() / "a.gpkg";
    std::string digest;
    {
        auto store = new_store(file);
        import_trips(store, 3);
        digest = store.digest();
    }
    {
        Database database{file, Database::Access::write};
        database.run("DROP TABLE event; DROP TABLE event_search; DROP TABLE published_event;"
                     "ALTER TABLE trip DROP COLUMN trimmed_mm;"
                     "UPDATE meta SET value = '3' WHERE key = 'version'");
    }
    EXPECT_THAT(refusal_of([&] { StoreReader::open(file); }),
                HasSubstr("is a database of version 3, expected version 7: run 'macadam upgrade"));
    const auto done = upgrade_store(file, {}, [](auto) { return Progress{}; });
    EXPECT_EQ(done.from_version, 3);
    EXPECT_EQ(done.to_version, 7);
    EXPECT_EQ(done.cars, 0U);
    EXPECT_FALSE(done.made_key);
    EXPECT_EQ(done.digest, digest);
    auto store = RoadStore::open(file);
    EXPECT_EQ(store.digest(), digest);
    EXPECT_THAT(store.events({}), IsEmpty());
    for (const int number : {0, 1, 2}) {
        stage_trip(store, trip_record(number), passes_of(number), {}, events_of(number));
    }
    store.maintenance.commit_staged("anew");
    EXPECT_THAT(store.events({}), SizeIs(2));
}

TEST(StoreEvents, ThatNobodyKnowsAreNamed) {
    const auto file = test_folder() / "a.gpkg";
    { store_of(file, {0, 1}); }
    {
        Database database{file, Database::Access::write};
        database.run("UPDATE event SET kind = 9");
    }
    const auto store = StoreReader::open(file);
    EXPECT_THAT(refusal_of([&] { store.events({}); }),
                HasSubstr("a.gpkg: kind of an event is 9, expected 0 to 3; the database was "
                          "modified by another program"));
    {
        Database database{file, Database::Access::write};
        database.run("UPDATE event SET kind = 0, sd_um = 0");
    }
    EXPECT_THAT(refusal_of([&] { store.events({}); }),
                HasSubstr("a.gpkg: sd_um of an event is 0, expected 1 to 1000000000"));
    {
        Database database{file, Database::Access::write};
        database.run("UPDATE event SET sd_um = 1000, size_um = -30000");
    }
    EXPECT_THAT(refusal_of([&] { store.events({}); }),
                HasSubstr("a.gpkg: size_um of an event is -30000, expected 0 to 1000000000"));
    {
        Database database{file, Database::Access::write};
        database.run("UPDATE event SET size_um = 4294997296"); // 30,000 in 32 bits
    }
    EXPECT_THAT(refusal_of([&] { store.events({}); }),
                HasSubstr("a.gpkg: size_um of an event is 4294997296, expected 0 to 1000000000"));
}

// ------------------------------------------------------------------------------------- exports

std::string file_text(const std::filesystem::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

TEST(EventExport, WritesPointsInEveryFormat) {
    const auto folder = test_folder();
    const auto store = store_of(folder / "a.gpkg", {0, 1, 2});
    for (const auto suffix : event_export_suffixes()) {
        const auto file = folder / ("events" + std::string{suffix});
        EXPECT_EQ(export_events(store, {}, file), 2U) << suffix;
        EXPECT_GT(std::filesystem::file_size(file), 0U) << suffix;
    }
    EXPECT_THAT(file_text(folder / "events.csv"), HasSubstr("\npothole,moderate,unknown,30,"));
    EXPECT_THAT(file_text(folder / "events.geojson"),
                HasSubstr(R"("geometry":{"type":"Point","coordinates":[)"));
    EXPECT_THAT(file_text(folder / "events.kml"), HasSubstr("<name>pothole</name>"));

    Database database{folder / "events.gpkg", Database::Access::read};
    EXPECT_EQ(database.number("SELECT count(*) FROM events WHERE passes = 3"), 2);
    EXPECT_EQ(database.number("SELECT count(*) FROM rtree_events_geom"), 2);
    EXPECT_EQ(database.number("SELECT geometry_type_name = 'POINT' FROM gpkg_geometry_columns"), 1);
    EXPECT_THAT(refusal_of([&] { export_events(store, {}, folder / "events.shp"); }),
                HasSubstr("events.shp: suffix '.shp', expected one of .geojson, .geojsonl, .csv, "
                          ".gpkg, .kml for events"));
}

TEST(EventExport, OfNoEventsIsAnEmptyFile) {
    const auto folder = test_folder();
    const auto store = store_of(folder / "a.gpkg", {0});
    for (const auto suffix : event_export_suffixes()) {
        EXPECT_EQ(export_events(store, {}, folder / ("none" + std::string{suffix})), 0U) << suffix;
    }
    EXPECT_THAT(file_text(folder / "none.geojson"), HasSubstr("\"features\":[\n]}"));
}

} // namespace
} // namespace macadam::testing
