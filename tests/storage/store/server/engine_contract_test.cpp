// What a database does on any engine: the same sentences, tried on a GeoPackage and on PostgreSQL.

#include "mapping/conflation/network_conflation.hpp"
#include "mapping/geometry/area.hpp"
#include "mapping/network/build_network.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "support/files/files.hpp"
#include "support/roads/edited_network.hpp"
#include "support/roads/engine_world.hpp"
#include "support/roads/fleet_passes.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Gt;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Lt;
using ::testing::Not;
using ::testing::SizeIs;

constexpr int trip_count = 6;

/// A file with the same trips, imported in the opposite order.
class Oracle {
public:
    Oracle(const std::filesystem::path& file, const std::vector<int>& trips)
        : store_{new_store(file)} {
        const auto target = import_store_of(store_);
        for (auto number = trips.rbegin(); number != trips.rend(); ++number) {
            add_rich_trip(*target.trips, *number);
        }
        fuse_all(*target.trips);
    }
    RoadStore& store() { return store_; }

private:
    RoadStore store_;
};

std::vector<int> all_trips() {
    std::vector<int> trips;
    for (int number = 0; number < trip_count; ++number) {
        trips.push_back(number);
    }
    return trips;
}

std::vector<std::optional<SegmentState>> values_of(const StoreReader& store,
                                                   const SegmentFilter& filter) {
    std::vector<std::optional<SegmentState>> states;
    store.visit(filter, [&](const SegmentRecord& record) { states.push_back(record.state); });
    return states;
}

class DatabaseOnAnyEngine : public ::testing::TestWithParam<Engine> {
protected:
    void import_all() { import_rich_trips(*database_.import().trips, trip_count); }

    std::filesystem::path folder_ = test_folder();
    EngineDatabase database_{GetParam(), folder_};
};

INSTANTIATE_TEST_SUITE_P(Engines,
                         DatabaseOnAnyEngine,
                         ::testing::Values(Engine::geopackage, Engine::postgresql),
                         [](const auto& engine) { return name_of(engine.param); });

TEST_P(DatabaseOnAnyEngine, TakesEachTripOnce) {
    const auto store = database_.import();
    auto& trips = *store.trips;
    trips.make_missing_key();
    const RichTrip a{1}, b{2};
    const std::vector<NewTrip> twice{a.as_new(), b.as_new(), a.as_new()};
    EXPECT_THAT(trips.add_trips(twice), ElementsAre(true, true, false));
    EXPECT_FALSE(add_rich_trip(trips, 2));
    EXPECT_TRUE(trips.contains_trip(a.record.sha256));
    EXPECT_FALSE(trips.contains_trip(trip_record(3).sha256));
    EXPECT_TRUE(trips.is_trip_of(a.record.sha256, a.record.vehicle_id));
    EXPECT_FALSE(trips.is_trip_of(a.record.sha256, b.record.vehicle_id));
    const auto settings = trips.settings_of_trip(a.record.sha256);
    ASSERT_TRUE(settings);
    EXPECT_EQ(settings->method, a.record.method);
    EXPECT_EQ(settings->vehicle_model, a.record.vehicle_model);
    EXPECT_FALSE(trips.settings_of_trip(trip_record(3).sha256));
    EXPECT_EQ(database_.read().info().trips, 2U);
}

TEST_P(DatabaseOnAnyEngine, HasTheDigestOfAFileFilledInTheOppositeOrder) {
    import_all();
    EXPECT_EQ(database_.read().digest(),
              Oracle(folder_ / "all.gpkg", all_trips()).store().digest());
}

TEST_P(DatabaseOnAnyEngine, FusesWhatIsNewAndThenNothing) {
    const auto store = database_.import();
    EXPECT_EQ(store.trips->waiting(), 0U);
    add_rich_trip(*store.trips, 1);
    EXPECT_EQ(store.trips->waiting(), 20U);
    FusionRecord record;
    EXPECT_EQ(store.trips->refresh({}, record, BusyChunks::await), 20U);
    EXPECT_TRUE(record.audit);
    EXPECT_EQ(store.trips->waiting(), 0U);
    EXPECT_EQ(store.trips->refresh({}, record, BusyChunks::await), 0U);
    EXPECT_EQ(store.trips->alignment().drives, 2);
}

/// Adds a trip of another car over the first seven segments, and a survey of the first five.
void add_partial_trips(ImportTarget& trips) {
    auto car = trip_record(trip_count);
    car.vehicle_id = "car-apart";
    auto passes = passes_of(trip_count);
    passes.resize(7);
    const NewTrip by_car{&car, passes, {}, false, {}};
    auto survey = trip_record(trip_count + 1);
    survey.vehicle_id.clear();
    survey.reference = ReferenceNote{.relative_sd_ppm = 20'000, .row_mm = 10'000};
    auto measured = passes_of(trip_count + 1);
    measured.resize(5);
    const NewTrip by_survey{&survey, measured, {}, false, {}};
    const std::vector<NewTrip> both{by_car, by_survey};
    trips.add_trips(both);
    fuse_all(trips);
}

/// A filter of each kind, those of place around one segment. \param car  a pseudonym
std::vector<SegmentFilter> every_filter(const StoreReader& store, const std::string& car) {
    GeoBox box;
    SegmentFilter one;
    one.key = SegmentKey{1, true, 3};
    store.visit(one, [&](const SegmentRecord& record) {
        for (const auto& [lat_deg, lon_deg] : record.segment.line) {
            box = {std::min(box.west_deg, lon_deg),
                   std::min(box.south_deg, lat_deg),
                   std::max(box.east_deg, lon_deg),
                   std::max(box.north_deg, lat_deg)};
        }
    });
    std::vector<SegmentFilter> filters(18);
    filters[0] = one;
    filters[1].worst = 5;
    filters[2].period = Period{.from_ms = 1'765'000'000'000, .until_ms = {}};
    filters[3].box = box;
    filters[4].name_part = "rue";
    filters[5].min_passes = 7;
    filters[6].way_id = 1;
    filters[7].highway = "residential";
    filters[8].class_name = "good";
    filters[9].class_name = "fair";
    filters[10].class_name = "poor";
    filters[11].min_vehicles = 4;
    filters[12].area = std::make_shared<const Area>(
        std::vector<Polygon>{{{{box.south_deg - 1e-6, box.west_deg - 1e-6},
                               {box.north_deg + 1e-6, box.west_deg - 1e-6},
                               {box.north_deg + 1e-6, box.east_deg + 1e-6}}}});
    filters[13].cars_alone = true;
    filters[14].vehicle = car;
    filters[15].ranges = std::vector<SegmentRange>{{1, false, 4, 6}, {1, true, 0, 2}};
    filters[16].with_state_only = false;
    return filters; // the last one: all with a state
}

TEST_P(DatabaseOnAnyEngine, AnswersQueriesByEveryFilter) {
    import_all();
    add_partial_trips(*database_.import().trips);
    Oracle oracle{folder_ / "oracle.gpkg", all_trips()};
    add_partial_trips(*import_store_of(oracle.store()).trips);
    const auto reader = database_.read();
    // Each database has a key of its own.
    const auto filters = every_filter(reader, reader.key()->pseudonym("car-apart"));
    const auto of_oracle =
        every_filter(oracle.store(), oracle.store().key()->pseudonym("car-apart"));
    const auto fused = values_of(reader, filters.back());
    ASSERT_THAT(fused, SizeIs(20));
    std::size_t in_classes = 0;
    for (std::size_t i = 0; i < filters.size(); ++i) {
        const auto values = values_of(reader, filters[i]);
        EXPECT_EQ(values, values_of(oracle.store(), of_oracle[i])) << i;
        in_classes += filters[i].class_name.empty() ? 0 : values.size();
    }
    EXPECT_EQ(in_classes, fused.size());
    EXPECT_THAT(values_of(reader, filters[0]), SizeIs(1));                             // the key
    EXPECT_THAT(values_of(reader, filters[3]), AllOf(Not(IsEmpty()), SizeIs(Lt(20)))); // the box
    EXPECT_THAT(values_of(reader, filters[5]), SizeIs(7));  // of all trips
    EXPECT_THAT(values_of(reader, filters[11]), SizeIs(7)); // four cars
    EXPECT_THAT(values_of(reader, filters[12]), AllOf(Not(IsEmpty()), SizeIs(Lt(20)))); // the area
    EXPECT_NE(values_of(reader, filters[13]), fused);            // without the survey
    EXPECT_THAT(values_of(reader, filters[14]), SizeIs(7));      // the car
    EXPECT_THAT(values_of(reader, filters[15]), SizeIs(4));      // the ranges
    EXPECT_THAT(values_of(reader, filters[16]), SizeIs(Gt(20))); // also without a pass
    EXPECT_THAT(reader.events({}), SizeIs(oracle.store().events({}).size()));
}

TEST_P(DatabaseOnAnyEngine, TellsTheHistoryOfASegment) {
    import_all();
    Oracle oracle{folder_ / "oracle.gpkg", all_trips()};
    const auto history = database_.read().history({1, true, 3});
    const auto expected = oracle.store().history({1, true, 3});
    ASSERT_EQ(history.size(), expected.size());
    for (std::size_t i = 0; i < history.size(); ++i) {
        EXPECT_EQ(history[i].trip_sha256, expected[i].trip_sha256);
        EXPECT_EQ(history[i].pass.iri_um, expected[i].pass.iri_um);
        EXPECT_EQ(history[i].lag_m, expected[i].lag_m);
        EXPECT_EQ(history[i].utc_ms, expected[i].utc_ms);
    }
    EXPECT_THAT(database_.read().changes({1, true, 3}), Not(IsEmpty()));
}

TEST_P(DatabaseOnAnyEngine, ForgetsATripAsIfItHadNeverBeenThere) {
    import_all();
    const auto gone = trip_record(2).sha256;
    EXPECT_EQ(database_.forget({.trips = {gone}, .vehicles = {}}).trips, 1U);
    EXPECT_EQ(database_.read().digest(),
              Oracle(folder_ / "others.gpkg", {0, 1, 3, 4, 5}).store().digest());

    const auto store = database_.import();
    EXPECT_TRUE(store.trips->has_forgotten(gone));
    EXPECT_FALSE(add_rich_trip(*store.trips, 2));
    EXPECT_TRUE(add_rich_trip(*store.trips, 2, true));
    fuse_all(*store.trips);
    EXPECT_EQ(database_.read().digest(),
              Oracle(folder_ / "all.gpkg", all_trips()).store().digest());
}

TEST_P(DatabaseOnAnyEngine, ForgetsACarByItsName) {
    import_all();
    const auto car = trip_record(0).vehicle_id;
    const auto forgotten = database_.forget({.trips = {}, .vehicles = {car}});
    EXPECT_GE(forgotten.trips, 1U);
    EXPECT_EQ(database_.read().info().trips, trip_count - forgotten.trips);
    EXPECT_THAT(refusal_of([&] { database_.forget({.trips = {}, .vehicles = {car}}); }),
                HasSubstr("has no trip of vehicle"));
}

TEST_P(DatabaseOnAnyEngine, ForgetsATripByWhichCarsWereCalibrated) {
    constexpr int fleet_trips = 30;
    auto file = fleet_store(folder_ / "oracle.gpkg", fleet_trips);
    {
        const auto database = database_.import();
        for (int number = 0; number < fleet_trips; ++number) {
            const auto record = trip_record(number);
            const auto passes = passes_of_fleet(number);
            const NewTrip trip{&record, passes, {}, false, {}};
            database.trips->add_trips({&trip, 1});
        }
        fuse_all(*database.trips);
    }
    file.maintenance.calibrate();
    database_.maintain().maintenance.calibrate();
    EXPECT_EQ(database_.read().digest(), file.digest());
    const ForgetRequest request{.trips = {trip_record(2).sha256}, .vehicles = {}};
    EXPECT_TRUE(file.maintenance.forget(request).calibrated);
    EXPECT_TRUE(database_.forget(request).calibrated);
    EXPECT_EQ(database_.read().digest(), file.digest());
}

TEST_P(DatabaseOnAnyEngine, CountsPassesFromTheDayOfAResurfacing) {
    import_all();
    Oracle oracle{folder_ / "oracle.gpkg", all_trips()};
    const std::vector<SegmentKey> resurfaced{{1, true, 0}, {1, true, 1}};
    const auto set_in = [&](RoadStore store) {
        return store.maintenance.set_valid_from(resurfaced, 1'765'000'000'000, "new surface");
    };
    EXPECT_EQ(set_in(database_.maintain()), 2U);
    set_in(oracle.store());
    const auto reader = database_.read();
    EXPECT_EQ(reader.digest(), oracle.store().digest());
    EXPECT_THAT(reader.valid_since(), SizeIs(2));

    const auto store = database_.import(); // later imports keep to it
    add_rich_trip(*store.trips, 7);
    fuse_all(*store.trips);
    add_rich_trip(*import_store_of(oracle.store()).trips, 7);
    fuse_all(*import_store_of(oracle.store()).trips);
    EXPECT_EQ(database_.read().digest(), oracle.store().digest());
}

TEST_P(DatabaseOnAnyEngine, KeepsChangesOfValuesFor400Days) {
    const bool is_on_server = GetParam() == Engine::postgresql;
    const auto make_all_old = [&] {
        const std::string update = "SET at = '2020-02-29T12:00:00.000Z'";
        if (is_on_server) {
            ServerConnection{database_.name()}.run("UPDATE macadam.audit " + update);
        } else {
            Database{database_.name(), Database::Access::write}.run("UPDATE audit " + update);
        }
    };
    const auto changes = [&] {
        return is_on_server ? ServerConnection{database_.name()}.number(
                                  "SELECT count(*) FROM macadam.state_change")
                            : Database{database_.name(), Database::Access::read}.number(
                                  "SELECT count(*) FROM state_change");
    };
    const SegmentKey key{1, true, 2};
    import_all();
    database_.maintain().maintenance.set_valid_from({&key, 1}, 1'765'000'000'000, "new surface");
    add_rich_trip(*database_.import().trips, trip_count);
    fuse_all(*database_.import().trips);
    EXPECT_GT(changes(), 40); // twenty segments, by two imports and a new surface
    make_all_old();
    fuse_all(*database_.import().trips); // removes them, though there is nothing to fuse
    EXPECT_EQ(changes(), 0);
    const auto store = database_.read();
    const auto entries = store.audit();
    ASSERT_THAT(entries, SizeIs(1)); // not those of imports
    EXPECT_EQ(entries[0].what, "valid-from");
    EXPECT_EQ(entries[0].segments, std::nullopt); // no longer known
    EXPECT_THAT(store.changes(key), IsEmpty());

    add_rich_trip(*database_.import().trips, trip_count + 1);
    fuse_all(*database_.import().trips);
    EXPECT_THAT(database_.read().audit(), SizeIs(2));
    EXPECT_THAT(database_.read().changes(key), SizeIs(1));
    Oracle file{folder_ / "oracle.gpkg", {0, 1, 2, 3, 4, 5, 6, 7}};
    file.store().maintenance.set_valid_from({&key, 1}, 1'765'000'000'000, "new surface");
    EXPECT_EQ(database_.read().digest(), file.store().digest());
}

TEST_P(DatabaseOnAnyEngine, ReplacesTheResultsOfATrip) {
    import_all();
    Oracle oracle{folder_ / "oracle.gpkg", all_trips()};
    const auto restage = [](RoadStore store) {
        RichTrip again{2};
        for (auto& pass : again.passes) {
            pass.iri_um += 500;
        }
        EXPECT_TRUE(stage_trip(store, again.record, again.passes, again.traces, again.events));
        EXPECT_EQ(store.maintenance.commit_staged("method smoother").generation, 2);
    };
    restage(database_.maintain());
    restage(oracle.store());
    EXPECT_EQ(database_.read().digest(), oracle.store().digest());
    EXPECT_EQ(database_.read().info().generation, 2);
}

TEST_P(DatabaseOnAnyEngine, MovesItsPassesToANewerMap) {
    import_all();
    Oracle oracle{folder_ / "oracle.gpkg", all_trips()};
    const auto update = [](RoadStore store) {
        const auto before = store.roads();
        auto network = edited(copies_of_ways(before));
        network.ways.front().way.name = "Rue Neuve";
        nudge(network, [](std::int64_t, const GeoPoint& at) {
            return GeoPoint{at.lat_deg + 1e-6, at.lon_deg};
        });
        const auto after = build_network(ways_of(network));
        return store.maintenance.update_network(
            before, after, change_between(before, after), {"newer.osm", ""});
    };
    EXPECT_TRUE(update(database_.maintain()).changed);
    EXPECT_TRUE(update(oracle.store()).changed);
    EXPECT_EQ(database_.read().digest(), oracle.store().digest());

    const auto store = database_.import(); // over the new roads
    add_rich_trip(*store.trips, 7);
    fuse_all(*store.trips);
    add_rich_trip(*import_store_of(oracle.store()).trips, 7);
    fuse_all(*import_store_of(oracle.store()).trips);
    EXPECT_EQ(database_.read().digest(), oracle.store().digest());
}

TEST_P(DatabaseOnAnyEngine, RemembersAnImportThatDidNotEnd) {
    {
        const auto store = database_.import();
        EXPECT_FALSE(store.trips->begin_import("a", 3).earlier);
        add_rich_trip(*store.trips, 1);
        const auto other = database_.import();
        EXPECT_TRUE(other.trips->begin_import("a", 3).same_runs);
        EXPECT_FALSE(other.trips->begin_import("b", 3).same_runs);
        EXPECT_TRUE(other.trips->begin_import("b", 3).other_runs);
        other.trips->end_import("b");
    }
    const auto store = database_.import();
    const auto begun = store.trips->begin_import("a", 3);
    EXPECT_FALSE(begun.same_runs);
    ASSERT_TRUE(begun.earlier);
    EXPECT_EQ(begun.earlier->trips_asked, 3U);
    EXPECT_EQ(begun.earlier->trips_added, 1U);
    store.trips->end_import("a");
    EXPECT_FALSE(database_.import().trips->begin_import("a", 3).earlier);
}

TEST_P(DatabaseOnAnyEngine, TakesAllTripsOfACallOrNone) {
    const auto store = database_.import();
    const RichTrip good{1};
    RichTrip elsewhere{2};
    elsewhere.passes.front().segment.index = 400;
    const std::vector<NewTrip> both{good.as_new(), elsewhere.as_new()};
    EXPECT_THAT(refusal_of([&] { store.trips->add_trips(both); }),
                HasSubstr("has no segment '1+0400', expected passes over its own network"));
    EXPECT_FALSE(store.trips->contains_trip(good.record.sha256));
    EXPECT_EQ(store.trips->waiting(), 0U);
    EXPECT_TRUE(add_rich_trip(*store.trips, 1));
}

} // namespace
} // namespace macadam::testing
