// Regions cut out into files: the same sentences, tried on a GeoPackage and on PostgreSQL.

#include "storage/store/copy/region_cut.hpp"

#include "mapping/geometry/area.hpp"
#include "mapping/network/build_network.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "support/files/files.hpp"
#include "support/program/postgres_server.hpp"
#include "support/roads/crowd_drives.hpp"
#include "support/roads/engine_world.hpp"
#include "support/roads/region_cuts.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

std::vector<SegmentRecord> records_in(const StoreReader& store, const SegmentFilter& filter) {
    std::vector<SegmentRecord> records;
    store.visit(filter, [&](const SegmentRecord& record) { records.push_back(record); });
    return records;
}

SegmentFilter of_way(std::int64_t id) {
    SegmentFilter filter;
    filter.way_id = id;
    filter.with_state_only = false;
    return filter;
}

/// Whatever SQLite finds wrong with a file, also references to rows that are not there.
std::int64_t faults_in(const fs::path& file) {
    Database database{file, Database::Access::read};
    return database.number("SELECT (SELECT count(*) FROM pragma_foreign_key_check) +"
                           " (SELECT count(*) FROM pragma_integrity_check"
                           " WHERE integrity_check <> 'ok')");
}

std::string bytes_of(const fs::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

class RegionCuts : public ::testing::TestWithParam<Engine> {
protected:
    /// Trips 0 to 3 over way 1, 4 over way 3, and 5 over both.
    void SetUp() override {
        {
            const auto open = database_.import();
            import_rich_trips(*open.trips, 4);
            add_passes(*open.trips, 4, false);
            add_passes(*open.trips, 5, true);
            fuse_all(*open.trips);
        }
        const std::vector<SegmentKey> resurfaced{{1, true, 0}, {3, true, 0}};
        database_.maintain().maintenance.set_valid_from(resurfaced, 1'761'000'000'000, {});
    }

    StoreCopy cut(const GeoBox& box, const std::string& name = "cut.gpkg") {
        return cut_from(database_.name(), region_of(box), folder_ / name);
    }

    fs::path folder_ = test_folder();
    EngineDatabase database_{GetParam(), folder_, cut_roads().roads, settings()};

private:
    static void add_passes(ImportTarget& trips, int number, bool also_way_1) {
        auto record = trip_record(number);
        record.vehicle_id = also_way_1 ? "car-0" : "car-far";
        std::vector<Pass> passes;
        for (auto pass : passes_of(number)) {
            const bool is_begin = pass.segment.forward && pass.segment.index < 2;
            if (is_begin && also_way_1) {
                passes.push_back(pass);
            }
            if (is_begin) {
                pass.segment.way_id = 3;
                passes.push_back(pass);
            }
        }
        const NewTrip trip{&record, passes, {}, false, {}};
        trips.add_trips({&trip, 1});
    }
};

INSTANTIATE_TEST_SUITE_P(Engines,
                         RegionCuts,
                         ::testing::Values(Engine::geopackage, Engine::postgresql),
                         [](const auto& engine) { return name_of(engine.param); });

TEST_P(RegionCuts, AreDatabasesOfWhatDroveThere) {
    const auto copy = cut(box_around(cut_roads().places.at('C')));
    EXPECT_EQ(copy.trips, 5U);
    EXPECT_EQ(copy.passes, 82U);
    EXPECT_TRUE(read_key(copy.key_file));
    const auto file = folder_ / "cut.gpkg";
    EXPECT_EQ(faults_in(file), 0);
    const auto store = RoadStore::open(file);
    EXPECT_EQ(store.digest(), copy.digest);
    EXPECT_THAT(store.usage().cars, SizeIs(3)); // without car-far
    EXPECT_THAT(store.valid_since(), SizeIs(1));
    const auto whole = database_.read();
    const auto values = records_in(store, of_way(1)), originals = records_in(whole, of_way(1));
    ASSERT_EQ(values.size(), 22U);
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_EQ(values[i].segment.key, originals[i].segment.key);
        EXPECT_EQ(values[i].segment.line, originals[i].segment.line);
        EXPECT_EQ(values[i].state, originals[i].state);
    }
    EXPECT_EQ(store.events({}).size(), whole.events({}).size());
    EXPECT_EQ(store.history({1, true, 0}).size(), whole.history({1, true, 0}).size());
    const auto changes = store.changes({1, true, 0});
    EXPECT_EQ(changes.size(), whole.changes({1, true, 0}).size());
    const auto audit = store.audit();
    ASSERT_THAT(audit, Not(IsEmpty()));
    const auto is_cut = [](const AuditEntry& entry) { return entry.what == "cut"; };
    const auto told = std::ranges::find_if(audit, is_cut);
    ASSERT_NE(told, audit.end());
    EXPECT_EQ(told->detail, "the box of " + database_.name());
    EXPECT_THAT(bytes_of(file),
                AllOf(HasSubstr(trip_record(5).sha256), Not(HasSubstr(trip_record(4).sha256))));
}

TEST_P(RegionCuts, HaveTheWaysThatMeetTheirsWithoutValues) {
    cut(box_around(cut_roads().places.at('C')));
    const auto store = RoadStore::open(folder_ / "cut.gpkg");
    const auto meeting = records_in(store, of_way(2));
    EXPECT_THAT(meeting, Not(IsEmpty()));
    for (const auto& record : meeting) {
        EXPECT_FALSE(record.state);
    }
    EXPECT_THAT(records_in(store, of_way(3)), IsEmpty());
    EXPECT_EQ(store.info().segments, records_in(store, of_way(1)).size() + meeting.size());
}

TEST_P(RegionCuts, TakeMoreTripsWithTheValuesOfTheWhole) {
    cut(box_around(cut_roads().places.at('C')));
    const auto store = RoadStore::open(folder_ / "cut.gpkg");
    EXPECT_FALSE(add_rich_trip(*import_store_of(store).trips, 1)); // is known
    for (const auto& open : {import_store_of(store), database_.import()}) {
        EXPECT_TRUE(add_rich_trip(*open.trips, 6));
        fuse_all(*open.trips);
    }
    const auto now = records_in(store, of_way(1)), whole = records_in(database_.read(), of_way(1));
    ASSERT_EQ(now.size(), whole.size());
    for (std::size_t i = 0; i < now.size(); ++i) {
        EXPECT_EQ(now[i].state, whole[i].state);
    }
}

TEST_P(RegionCuts, HaveTheDigestOfTheWholeInARegionOfAllRoads) {
    const auto digest = database_.read().digest();
    const auto copy = cut({4, 45, 5, 46});
    EXPECT_EQ(copy.digest, digest);
    EXPECT_EQ(copy.trips, 6U);
}

TEST_P(RegionCuts, KeepToTheOutlineOfAnArea) {
    const auto places = cut_roads().places;
    const auto d = places.at('D'), c = places.at('C');
    Region region{.place = {}, .words = "the area"};
    // A triangle with one side between the rows of the drawing, whose box holds way 1 too.
    region.place.area =
        std::make_shared<const Area>(std::vector<Polygon>{{{{d.lat_deg - 1e-5, d.lon_deg - 1e-5},
                                                            {d.lat_deg + 1e-5, d.lon_deg - 1e-5},
                                                            {c.lat_deg + 1e-2, c.lon_deg + 1.0},
                                                            {d.lat_deg - 1e-5, c.lon_deg + 1.0}}}});
    const auto copy = cut_from(database_.name(), region, folder_ / "cut.gpkg");
    EXPECT_EQ(copy.trips, 2U);
    EXPECT_EQ(copy.passes, 4U);
    EXPECT_EQ(faults_in(folder_ / "cut.gpkg"), 0);
    EXPECT_THAT(bytes_of(folder_ / "cut.gpkg"), Not(HasSubstr(trip_record(0).sha256)));
}

TEST_P(RegionCuts, RefuseWhatTheyCannotCut) {
    EXPECT_THAT(refusal_of([&] {
                    cut({10, 50, 11, 51});
                }),
                HasSubstr("no road lies in the box; its roads lie in the box 4.8"));
    EXPECT_FALSE(fs::exists(folder_ / "cut.gpkg"));
    const auto at = box_around(cut_roads().places.at('C'));
    cut(at);
    EXPECT_THAT(refusal_of([&] { cut(at); }), HasSubstr("cut.gpkg: already exists"));
}

TEST_P(RegionCuts, OfACutAreThatCut) {
    const auto at = box_around(cut_roads().places.at('C'));
    const auto first = cut(at),
               second =
                   cut_from((folder_ / "cut.gpkg").string(), region_of(at), folder_ / "again.gpkg");
    EXPECT_EQ(second.digest, first.digest);
    EXPECT_THAT(different_rows(folder_ / "again.gpkg", folder_ / "cut.gpkg"), IsEmpty());
}

class RegionCutsOfALongWay : public ::testing::TestWithParam<Engine> {};

INSTANTIATE_TEST_SUITE_P(Engines,
                         RegionCutsOfALongWay,
                         ::testing::Values(Engine::geopackage, Engine::postgresql),
                         [](const auto& engine) { return name_of(engine.param); });

TEST_P(RegionCutsOfALongWay, HaveItsOtherChunksWithoutValues) {
    constexpr int segments = 65; // of 20 m, in chunks of 25
    const auto folder = test_folder();
    constexpr double length_deg = 0.0165;
    std::vector<Way> ways(1);
    ways[0].id = 1;
    ways[0].highway = "primary";
    ways[0].node_ids = {1, 2};
    ways[0].line = {{45.0, 5.0}, {45.0, 5.0 + length_deg}};
    const EngineDatabase database{GetParam(), folder, build_network(std::move(ways)), settings()};
    {
        const auto open = database.import();
        const auto record = trip_record(1);
        std::vector<Pass> passes;
        for (const unsigned shift : {0U, 40U}) {
            for (auto pass : passes_of(1)) {
                pass.segment.index += shift;
                passes.push_back(pass);
            }
        }
        const NewTrip trip{&record, passes, {}, false, {}};
        open.trips->add_trips({&trip, 1});
        fuse_all(*open.trips);
    }
    const auto region = region_of(box_around({45.0, 5.0 + length_deg * 45.5 / segments}));
    const auto copy = cut_from(database.name(), region, folder / "cut.gpkg");
    EXPECT_EQ(copy.passes, 20U); // of segments 40 to 49 there and back
    EXPECT_EQ(faults_in(folder / "cut.gpkg"), 0);
    const auto records = records_in(StoreReader::open(folder / "cut.gpkg"), of_way(1));
    const auto originals = records_in(database.read(), of_way(1));
    ASSERT_EQ(records.size(), originals.size());
    for (std::size_t i = 0; i < records.size(); ++i) {
        const auto& key = records[i].segment.key;
        EXPECT_EQ(key, originals[i].segment.key);
        const bool is_cut = key.index / 25 == 1;
        EXPECT_EQ(records[i].state, is_cut ? originals[i].state : std::nullopt);
    }
}

/// Crowd that has published once.
class RegionCutsOfACrowd : public ::testing::TestWithParam<Engine> {
protected:
    void SetUp() override {
        {
            const auto open = database_.import();
            for (int car = 0; car < 6; ++car) {
                const CrowdDrive drive{car, car, january_ms, 2000, false, road_count};
                const auto record = drive.record();
                const auto passes = drive.passes();
                const NewTrip trip{&record, passes, {}, false, {}};
                open.trips->add_trips({&trip, 1});
            }
            fuse_all(*open.trips);
        }
        database_.to_publish().maintenance.publish(roads_, february_ms);
    }

    static StoreSettings crowd() {
        auto crowd = settings();
        crowd.privacy = PrivacyProfile::crowd;
        return crowd;
    }

    static constexpr int road_count = 8;
    const Region road_4_ = region_of(box_around({45.0, 5.0 + 0.00254 * 3.5}));
    const RoadNetwork roads_ = roads_in_a_row(road_count);
    fs::path folder_ = test_folder();
    EngineDatabase database_{GetParam(), folder_, roads_, crowd()};
};

INSTANTIATE_TEST_SUITE_P(Engines,
                         RegionCutsOfACrowd,
                         ::testing::Values(Engine::geopackage, Engine::postgresql),
                         [](const auto& engine) { return name_of(engine.param); });

TEST_P(RegionCutsOfACrowd, KeepItsPublicationsAndItsKey) {
    const auto file = folder_ / "cut.gpkg";
    const auto copy = cut_from(database_.name(), road_4_, file);
    EXPECT_EQ(copy.trips, 6U);
    EXPECT_TRUE(read_key(copy.key_file));
    EXPECT_EQ(faults_in(file), 0);
    const auto shown = StoreReader::open(file);
    EXPECT_TRUE(shown.shows_published_alone());
    ASSERT_TRUE(shown.latest_publication());
    EXPECT_EQ(shown.latest_publication()->month, "2026-02");
    auto road = of_way(4);
    road.with_state_only = true;
    const auto published = records_in(shown, road);
    const auto originals = records_in(database_.read(Audience::anyone), road);
    ASSERT_THAT(published, SizeIs(10));
    ASSERT_THAT(originals, SizeIs(10));
    for (std::size_t i = 0; i < published.size(); ++i) {
        EXPECT_EQ(published[i].state, originals[i].state);
    }
}

TEST_P(RegionCutsOfACrowd, HaveNoMoreOfItFromAFileThanFromAServer) {
    cut_from(database_.name(), road_4_, folder_ / "cut.gpkg");
    std::string other;
    std::optional<PostgresServer> server;
    if (GetParam() == Engine::geopackage) {
        other = server.emplace().new_database("copy");
        copy_to_server(database_.name(), other, {}, {});
    } else {
        other = (folder_ / "copy.gpkg").string();
        copy_from_server(database_.name(), other, {});
    }
    cut_from(other, road_4_, folder_ / "other.gpkg");
    EXPECT_THAT(different_rows(folder_ / "other.gpkg", folder_ / "cut.gpkg"), IsEmpty());
}

TEST_P(RegionCutsOfACrowd, AreForWhoHoldsTheKeyOfAFile) {
    cut_from(database_.name(), road_4_, folder_ / "cut.gpkg");
    fs::remove(folder_ / "cut.gpkg.key");
    EXPECT_THAT(refusal_of([&] {
                    cut_from((folder_ / "cut.gpkg").string(), road_4_, folder_ / "again.gpkg");
                }),
                AllOf(HasSubstr("cut.gpkg: is of a crowd, and its key is not at "),
                      HasSubstr("for its operator only")));
    EXPECT_FALSE(fs::exists(folder_ / "again.gpkg"));
}

} // namespace
} // namespace macadam::testing
