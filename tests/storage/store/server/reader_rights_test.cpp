// What a role without rights on trips can find out about a crowd: its publications, by whatever
// statement.

#include "storage/store/server/reader_rights.hpp"

#include "mapping/conflation/network_conflation.hpp"
#include "mapping/network/build_network.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/importer/server_importer.hpp"
#include "storage/store/server/reader/server_mirror.hpp"
#include "storage/store/server/reader/server_reader.hpp"
#include "storage/store/server/replica/server_replica.hpp"
#include "support/files/files.hpp"
#include "support/program/postgres_server.hpp"
#include "support/roads/crowd_drives.hpp"
#include "support/roads/engine_world.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

class ReadersOfACrowd : public ::testing::Test {
protected:
    /// Seven cars, published, and two that are not; roles `guest` (a reader), `driver` (an
    /// importer) and `map`, which was given the view for QGIS alone.
    void make(PrivacyProfile privacy = PrivacyProfile::crowd) {
        as("boss").run("CREATE ROLE macadam_reader; CREATE ROLE macadam_importer;"
                       " CREATE ROLE macadam_operator; CREATE ROLE map LOGIN;"
                       " CREATE ROLE guest LOGIN IN ROLE macadam_reader;"
                       " CREATE ROLE driver LOGIN IN ROLE macadam_importer");
        StoreSettings settings;
        settings.network_source = "map";
        settings.privacy = privacy;
        settings.kept_logs = {.days = 30, .public_key = std::string(64, 'a')};
        auto store = RoadStore::create(file_, roads_in_a_row(3), settings);
        drive(store, 7, january_ms, 2000);
        if (privacy == PrivacyProfile::crowd) {
            store.maintenance.publish(roads_in_a_row(3), february_ms);
            drive(store, 2, february_ms, 7000);
        }
        copy_to_server(file_, address_, {}, {});
        ServerConnection{address_}.run("GRANT USAGE ON SCHEMA macadam TO map;"
                                       "GRANT SELECT ON macadam.roughness TO map");
        show_to_readers(address_);
        as("boss").run("ANALYZE");
    }

    void show_to_readers(const std::string& address) {
        ServerConnection server{address};
        if (is_crowd(server)) {
            show_publications_alone(server);
        }
    }

    ServerConnection as(const std::string& role) {
        return ServerConnection{server_.address("roads", role)};
    }

    std::vector<std::string> texts(const std::string& role, const std::string& sql) {
        auto server = as(role);
        std::vector<std::string> found;
        for (const auto& row : server.rows(sql)) {
            found.push_back(row[0].value_or("NULL"));
        }
        return found;
    }

    std::string refusal(const std::string& role, const std::string& sql) {
        return refusal_of([&] { as(role).rows(sql); });
    }

    PostgresServer server_;
    std::string address_ = server_.new_database("roads");
    fs::path file_ = test_folder() / "crowd.gpkg";

private:
    void drive(RoadStore& store, int cars, std::int64_t utc_ms, IriUm iri_um) {
        for (int car = 0; car < cars; ++car) {
            const CrowdDrive drive{trips_++, car, utc_ms, iri_um, true};
            add_trip(store, drive.record(), drive.passes(), {}, drive.events());
        }
        store.importer.refresh();
    }

    int trips_ = 0;
};

constexpr const char* readable =
    "SELECT relname FROM pg_class WHERE relnamespace = 'macadam'::regnamespace"
    " AND CASE WHEN relkind = 'S' THEN has_sequence_privilege(oid, 'USAGE, SELECT, UPDATE')"
    " WHEN relkind IN ('i', 'I') THEN false ELSE has_any_column_privilege(oid,"
    " 'SELECT, INSERT, UPDATE, REFERENCES') OR has_table_privilege(oid, 'DELETE, TRUNCATE, "
    "TRIGGER')"
    " END ORDER BY relname";

TEST_F(ReadersOfACrowd, MayReadItsRoadsAndPublicationsAndNothingElse) {
    make();
    for (const auto* const role : {"guest", "map"}) {
        EXPECT_THAT(texts(role, readable),
                    ElementsAre("background",
                                "meta",
                                "migration",
                                "place",
                                "publication",
                                "published_event",
                                "published_figure",
                                "published_state",
                                "road_ref",
                                "roughness",
                                "segment",
                                "way"))
            << role;
        EXPECT_THAT(texts(role, "SELECT DISTINCT iri FROM macadam.roughness"), ElementsAre("2"));
        EXPECT_THAT(texts(role, "SELECT vehicles FROM macadam.roughness"),
                    AllOf(SizeIs(10), Each(std::string{"5"})));
        EXPECT_THAT(texts(role, "SELECT month FROM macadam.publication"), ElementsAre("2026-02"));
    }
    for (const auto* const column : {"last_trip", "last_segment", "xmin", "ctid", "*"}) {
        EXPECT_THAT(refusal("guest", fmt::format("SELECT {} FROM macadam.publication", column)),
                    HasSubstr("permission denied"))
            << column;
    }
    EXPECT_THAT(refusal("guest", "EXPLAIN SELECT * FROM macadam.trip"),
                HasSubstr("permission denied"));
}

TEST_F(ReadersOfACrowd, SeeNoSettingsThatTellOfCarsAndLogs) {
    make();
    const std::string keys = "SELECT key FROM macadam.meta ORDER BY key";
    EXPECT_THAT(texts("guest", keys),
                ElementsAre("attribution",
                            "class_table",
                            "network_m",
                            "network_rows",
                            "network_sha256",
                            "network_source",
                            "privacy",
                            "published_rows",
                            "segment_length_m",
                            "segments"));
    // A function of their own that tells what it is asked about sees no other rows.
    auto guest = as("guest");
    guest.run(
        "CREATE FUNCTION pg_temp.tell(text) RETURNS boolean LANGUAGE plpgsql COST 0.0001 AS"
        " $$BEGIN IF $1 ~ 'key' THEN RAISE EXCEPTION 'saw %', $1; END IF; RETURN true; END$$");
    EXPECT_EQ(guest.number("SELECT count(*) FROM macadam.meta WHERE pg_temp.tell(key)"), 10);
    EXPECT_THAT(refusal_of([&] { open_server_import(server_.address("roads", "guest")); }),
                HasSubstr("the role may not import; its owner grants macadam_importer"));
    EXPECT_THAT(texts("driver", keys), AllOf(Contains("key_id"), Contains("kept_logs_days")));
}

TEST_F(ReadersOfACrowd, FindNothingInStatisticsOfColumns) {
    make();
    const std::string columns = "SELECT DISTINCT tablename || '.' || attname FROM pg_stats"
                                " WHERE schemaname = 'macadam'";
    const auto seen = texts("guest", columns);
    EXPECT_THAT(seen,
                AllOf(Contains("published_state.iri"), Not(Contains("publication.last_trip"))));
    for (const auto* const table : {"trip",
                                    "drive",
                                    "vehicle",
                                    "segment_state",
                                    "published_until",
                                    "chunk",
                                    "event",
                                    "meta"}) {
        EXPECT_THAT(seen, Each(Not(StartsWith(fmt::format("{}.", table))))) << table;
    }
    EXPECT_THAT(texts("boss", columns), Contains("trip.sha256"));
}

TEST_F(ReadersOfACrowd, SeeNoneOfTheServersActivityOnceASuperuserHidIt) {
    make();
    {
        auto owner = as("owner");
        EXPECT_TRUE(is_activity_open(owner));
    }
    EXPECT_THAT(texts("guest", "SELECT n_tup_ins FROM pg_stat_user_tables WHERE relname = 'trip'"),
                Not(IsEmpty()));
    as("boss").run("CREATE EXTENSION pg_stat_statements SCHEMA public");
    show_to_readers(server_.address("roads"));
    show_to_readers(server_.address("roads")); // changes nothing more
    auto owner = as("owner");
    EXPECT_FALSE(is_activity_open(owner));
    auto views = texts("boss",
                       "SELECT relnamespace::regnamespace || '.' || relname FROM pg_class"
                       " WHERE relkind = 'v' AND relname ~ '^pg_stat' AND relname !~ '^pg_stats'");
    EXPECT_THAT(views, IsSupersetOf({"pg_catalog.pg_stat_activity", "public.pg_stat_statements"}));
    views.insert(views.end(), {"pg_locks", "pg_replication_slots", "pg_prepared_xacts"});
    for (const auto& view : views) {
        EXPECT_THAT(refusal("guest", "SELECT * FROM " + view), HasSubstr("permission denied"))
            << view;
    }
    for (const std::string value : {"pg_relation_size('macadam.segment')",
                                    "pg_total_relation_size('macadam.segment')",
                                    "pg_database_size('roads')",
                                    "pg_stat_get_live_tuples('macadam.segment'::regclass)",
                                    "pg_try_advisory_lock(1)",
                                    "pg_try_advisory_xact_lock(1)",
                                    "pg_current_wal_lsn()",
                                    "(SELECT sum(reltuples) FROM pg_class)",
                                    "(SELECT sum(relpages) FROM pg_class)"}) {
        EXPECT_THAT(refusal("guest", "SELECT " + value), HasSubstr("permission denied")) << value;
    }
    // Everybody works on.
    const auto guest = StoreReader{
        open_server_reader(server_.address("roads", "guest"), {}, Audience::operator_, {}, {})};
    EXPECT_TRUE(guest.shows_published_alone());
    const auto driver = open_server_import(server_.address("roads", "driver"));
    const CrowdDrive drive{100, 3, march_ms};
    const auto record = drive.record();
    const auto passes = drive.passes();
    const NewTrip trip{&record, passes, {}, false, {}};
    EXPECT_THAT(driver.trips->add_trips({&trip, 1}), ElementsAre(true));
    fuse_all(*driver.trips);
    const auto all = StoreReader{
        open_server_reader(server_.address("roads", "driver"), {}, Audience::operator_, {}, {})};
    EXPECT_EQ(all.info().trips, 10U);
    EXPECT_EQ(RoadStore{open_server_replica(address_, {}, {})}
                  .maintenance.publish(roads_in_a_row(3), march_ms + day_ms)
                  .publication.number,
              2);
}

TEST_F(ReadersOfACrowd, KeepCopiesOfNothingElse) {
    make();
    auto guest = as("guest");
    const auto kept = refreshed_mirror(guest, ServerContent::published, {}, {});
    EXPECT_FALSE(fs::exists(key_file_of(kept)));
    const auto rows = rows_of_tables(kept);
    EXPECT_THAT(rows, Contains(StartsWith("published_state|")));
    EXPECT_THAT(rows, Contains("meta|privacy|crowd"));
    for (const std::string table : {"trip",
                                    "vehicle",
                                    "pass",
                                    "trace",
                                    "event",
                                    "segment_state",
                                    "strip_state",
                                    "audit",
                                    "published_until",
                                    "published_pending",
                                    "meta|key_id",
                                    "meta|kept_logs_days",
                                    "meta|last_of_keys"}) {
        EXPECT_THAT(rows, Each(Not(StartsWith(table + "|")))) << table;
    }
    EXPECT_THAT(rows, Contains(StartsWith("publication|1|2026-02|0|0|")));

    EXPECT_EQ(refreshed_mirror(guest, ServerContent::published, {}, {}), kept);
    RoadStore{open_server_replica(address_, {}, {})}.maintenance.forget(
        {.trips = {}, .vehicles = {"car 6"}}); // nor does its time show
    EXPECT_EQ(refreshed_mirror(guest, ServerContent::published, {}, {}), kept);
    RoadStore{open_server_replica(address_, {}, {})}.maintenance.publish(roads_in_a_row(3),
                                                                         march_ms);
    const auto next = refreshed_mirror(guest, ServerContent::published, {}, {});
    EXPECT_NE(next, kept);
    EXPECT_FALSE(fs::exists(kept));
}

TEST_F(ReadersOfACrowd, LoseWhatTheySawOfOwnCars) {
    make(PrivacyProfile::own);
    as("owner").run("GRANT SELECT ON macadam.segment_state, macadam.drive, macadam.roughness TO map"
                    " WITH GRANT OPTION; GRANT SELECT ON macadam.chunk_state TO PUBLIC");
    as("map").run("GRANT SELECT ON macadam.segment_state TO guest");
    EXPECT_THAT(texts("guest", readable), Contains("segment_state"));
    RoadStore{open_server_replica(address_, {}, {})}.maintenance.make_crowd();
    for (const auto* const role : {"guest", "map"}) {
        EXPECT_THAT(texts(role, readable),
                    AllOf(Contains("roughness"),
                          Not(Contains("segment_state")),
                          Not(Contains("chunk_state")),
                          Not(Contains("drive"))))
            << role;
        EXPECT_THAT(texts(role, "SELECT fid FROM macadam.roughness"), IsEmpty());
    }
    as("owner").run("GRANT SELECT ON macadam.segment_state TO map");
    EXPECT_THAT(refusal_of([&] { show_to_readers(server_.address("roads", "driver")); }),
                HasSubstr("the role does not own the database"));
    show_to_readers(address_);
    EXPECT_THAT(texts("map", readable), Not(Contains("segment_state")));
}

TEST_F(ReadersOfACrowd, LoseSingleColumnsAndWhatOthersGaveThem) {
    make(PrivacyProfile::own);
    as("boss").run("CREATE ROLE clerk LOGIN");
    as("owner").run("GRANT USAGE ON SCHEMA macadam TO clerk;"
                    "GRANT SELECT (id, t0_utc_ms) ON macadam.trip TO clerk;"
                    "GRANT SELECT ON macadam.drive TO driver WITH GRANT OPTION");
    as("driver").run("GRANT SELECT ON macadam.drive TO guest");
    ASSERT_THAT(texts("clerk", readable), ElementsAre("trip"));
    ASSERT_THAT(texts("guest", readable), Contains("drive"));
    RoadStore{open_server_replica(address_, {}, {})}.maintenance.make_crowd();
    EXPECT_THAT(texts("clerk", readable), IsEmpty());
    EXPECT_THAT(texts("guest", readable), Not(Contains("drive")));
    EXPECT_THAT(texts("driver", readable), Contains("drive"));
}

TEST_F(ReadersOfACrowd, AreSeenToSeeItFromOtherDatabasesOfTheServer) {
    make();
    auto owner = as("owner");
    EXPECT_THAT(open_databases_beside(owner), ElementsAre("postgres", "template1"));
    as("boss").run("REVOKE CONNECT ON DATABASE postgres, template1 FROM PUBLIC");
    EXPECT_THAT(open_databases_beside(owner), IsEmpty());
}

TEST_F(ReadersOfACrowd, GetNothingByDefaultOfMapTilesThatAreAddedLater) {
    make();
    as("owner").run("ALTER DEFAULT PRIVILEGES IN SCHEMA macadam GRANT SELECT ON TABLES TO guest");
    const auto before_tables = texts("guest", readable);
    const auto before = roads_in_a_row(3);
    auto ways = copies_of_ways(before);
    ways.push_back({.id = 90,
                    .name = "",
                    .highway = "primary",
                    .node_ids = {90, 91},
                    .line = {{52.0, 13.0}, {52.0, 13.01}}});
    const auto after = build_network(ways);
    RoadStore{open_server_replica(server_.address("roads"), {}, {})}.maintenance.update_network(
        before, after, change_between(before, after), {"newer.osm", ""});
    EXPECT_EQ(texts("boss",
                    "SELECT DISTINCT relowner::regrole::text FROM pg_class"
                    " WHERE relnamespace = 'macadam'::regnamespace AND relname ~ '^drive_[0-9]+$'"),
              std::vector<std::string>{"owner"});
    EXPECT_EQ(texts("guest", readable), before_tables);
}

} // namespace
} // namespace macadam::testing
