// Databases copied to a real PostgreSQL server and back.

#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/reader/server_reader.hpp"

#include "mapping/passes/chunk_trace.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/store/put_background.hpp"
#include "storage/store/server/server_schema.hpp"
#include "support/files/files.hpp"
#include "support/program/postgres_server.hpp"
#include "support/roads/engine_world.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace macadam {
namespace {

using testing::add_trip;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::new_store;
using ::testing::Not;
using testing::passes_of;
using testing::PostgresServer;
using testing::refusal_of;
using testing::rows_of_tables;
using testing::small_country;
using testing::test_folder;
using testing::trip_record;

namespace fs = std::filesystem;

/// Database with traces, events, a survey, a control section, a day of resurfacing, and a trip that
/// is not fused yet.
void make_rich_store(const fs::path& file) {
    auto store = new_store(file);
    for (int number = 0; number < 4; ++number) {
        auto trip = trip_record(number);
        trip.row_reasons = {{"too_slow", 7U}};
        trip.trimmed_mm = 1000 * number;
        auto passes = passes_of(number);
        for (auto& pass : passes) {
            pass.drive = 0;
        }
        const RoughnessTrace trace{.chunk = {1, true, 0},
                                   .drive = 0,
                                   .first_m = -10,
                                   .iri = std::vector<RoughnessCode>(220, code_of(1.0 + number)),
                                   .left = {},
                                   .place_sd_mm = 900};
        const PassEvent pothole{.segment = {1, true, 3},
                                .occurrence = 0,
                                .kind = EventKind::pothole,
                                .track = WheelTrack::left,
                                .at_mm = 71'000,
                                .place_sd_mm = 800,
                                .size_um = 40'000,
                                .sd_um = 5'000,
                                .length_mm = 500};
        add_trip(store, trip, passes, {&trace, 1}, std::span{&pothole, 1});
    }
    auto survey = trip_record(4);
    survey.vehicle_id.clear();
    survey.reference = ReferenceNote{.relative_sd_ppm = 20'000, .row_mm = 10'000};
    add_trip(store, survey, passes_of(4));
    const std::vector<SegmentKey> resurfaced{{1, true, 0}, {1, true, 1}};
    store.maintenance.set_valid_from(resurfaced, 1'761'000'000'000, {});
    store.importer.refresh();
    add_trip(store, trip_record(5), passes_of(5));
    const auto box = background_box(small_country());
    put_background(file, box, [&](const BackgroundSink& sink) {
        const auto at = [&](double north, double east) {
            return packed({box.south_deg + north, box.west_deg + east});
        };
        sink.feature({BackgroundKind::water, {{at(0, 0), at(0.01, 0), at(0.01, 0.01)}}});
        sink.place({"Lyon", PlaceRank::city, {box.north_deg, box.east_deg}, 520'000});
        sink.road_ref({1, "D 12"});
    });
}

class StoreCopies : public ::testing::Test {
protected:
    StoreCopy copy_there() { return copy_to_server(file_, address_, {}, {}); }
    std::string refusal_there() {
        return refusal_of([&] { copy_there(); });
    }
    std::string refusal_back() {
        return refusal_of([&] { copy_from_server(address_, folder_ / "back.gpkg", {}); });
    }
    std::string one(const std::string& sql) {
        ServerConnection server{address_};
        return server.rows(sql).at(0).at(0).value_or("NULL");
    }
    /// Changes the database on the server as another program might.
    void change(const std::string& sql) { ServerConnection{address_}.run(sql); }

    PostgresServer server_;
    std::string address_ = server_.new_database("roads");
    fs::path folder_ = test_folder();
    fs::path file_ = folder_ / "roads.gpkg";
};

TEST_F(StoreCopies, GoThereAndBackWithEveryRow) {
    make_rich_store(file_);
    const auto there = copy_there();
    EXPECT_EQ(there.trips, 6U);
    EXPECT_EQ(there.passes, 120U);
    EXPECT_FALSE(there.by_superuser);
    EXPECT_EQ(there.digest, StoreReader::open(file_).digest());
    const auto back = copy_from_server(address_, folder_ / "back.gpkg", {});
    EXPECT_EQ(back.digest, there.digest);
    EXPECT_EQ(rows_of_tables(folder_ / "back.gpkg"), rows_of_tables(file_));

    auto store = RoadStore::open(folder_ / "back.gpkg"); // and it goes on from there
    auto original = RoadStore::open(file_);
    EXPECT_EQ(store.importer.refresh(), original.importer.refresh());
    EXPECT_EQ(store.digest(), original.digest());
}

TEST_F(StoreCopies, NeedTheKeyOfACrowdsFileWhichHidesItsTripsWithoutIt) {
    auto crowd = testing::settings();
    crowd.privacy = PrivacyProfile::crowd;
    static_cast<void>(RoadStore::create(file_, small_country(), crowd));
    fs::remove(folder_ / "roads.gpkg.key");
    EXPECT_THAT(refusal_there(), HasSubstr("roads.gpkg: is of a crowd, and its key is not at "));
    EXPECT_EQ(one("SELECT count(*) FROM pg_namespace WHERE nspname = 'macadam'"), "0");
}

TEST_F(StoreCopies, ShowTheSameValuesAndPassesInSql) {
    make_rich_store(file_);
    copy_there();
    Database database{file_, Database::Access::read};
    const auto in_file = [&](const std::string& sql) {
        auto select = database.prepare(sql);
        select.step();
        return select.text(0);
    };
    for (const std::string sum : {"sum(segment)",
                                  "sum(iri_left_um)",
                                  "sum(iri_right_um)",
                                  "sum(iri_um * segment)",
                                  "sum(sd_um * segment)",
                                  "sum(speed_mmps)",
                                  "sum(covered_mm)",
                                  "sum(confidence_ppm)",
                                  "sum(t_ms * segment)",
                                  "sum(trip)",
                                  "sum(drive)",
                                  "count(*)"}) {
        EXPECT_EQ(one("SELECT " + sum + " FROM macadam.pass"),
                  in_file("SELECT " + sum + " FROM pass"))
            << sum;
    }
    EXPECT_EQ(
        one("SELECT string_agg(concat_ws(' ', segment, iri, iri_sd, \"index\", class, passes,"
            " first_seen, validity), ',' ORDER BY fid) FROM macadam.roughness"),
        in_file("SELECT group_concat(segment || ' ' || iri || ' ' || iri_sd || ' ' || \"index\""
                " || ' ' || class || ' ' || passes || coalesce(' ' || first_seen, '') || ' ' ||"
                " validity) FROM (SELECT * FROM segment_state JOIN segment USING (fid)"
                " ORDER BY fid)"));
    EXPECT_EQ(one("SELECT count(*) FROM public.layer_styles WHERE f_table_name = 'roughness'"
                  " AND useasdefault"),
              "1");
    EXPECT_EQ(one("SELECT count(*) FROM macadam.segment WHERE public.ST_NPoints(geom) < 2"), "0");
}

TEST_F(StoreCopies, ExplainEveryObjectOfTheirSchema) {
    make_rich_store(file_);
    copy_there();
    EXPECT_EQ(one("SELECT string_agg(relname, ' ') FROM pg_class WHERE relnamespace ="
                  " 'macadam'::regnamespace AND relkind IN ('r', 'p', 'v') AND"
                  " obj_description(oid, 'pg_class') IS NULL"),
              "NULL");
    EXPECT_EQ(
        one("SELECT string_agg(relname || '.' || attname, ' ') FROM pg_attribute JOIN pg_class"
            " ON pg_class.oid = attrelid WHERE relnamespace = 'macadam'::regnamespace AND"
            " relkind IN ('r', 'p', 'v') AND NOT relispartition AND attnum > 0 AND"
            " col_description(attrelid, attnum) IS NULL"),
        "NULL");
    EXPECT_EQ(one("SELECT string_agg(proname, ' ') FROM pg_proc WHERE pronamespace ="
                  " 'macadam'::regnamespace AND obj_description(oid, 'pg_proc') IS NULL"),
              "NULL");
    EXPECT_EQ(one("SELECT count(*) FROM pg_class WHERE relname LIKE 'drive\\_%' AND relispartition"
                  " AND relkind = 'r'"),
              "1");
}

TEST_F(StoreCopies, AreReadAsTheFileIs) {
    make_rich_store(file_);
    copy_there();
    const auto reader = StoreReader{open_server_reader(address_, {}, Audience::operator_, {}, {})};
    const auto original = StoreReader::open(file_);
    EXPECT_EQ(reader.digest(), original.digest());
    const auto values_of = [](const StoreReader& store, const SegmentFilter& filter) {
        std::vector<std::optional<SegmentState>> states;
        store.visit(filter, [&](const SegmentRecord& record) { states.push_back(record.state); });
        return states;
    };
    SegmentFilter worst;
    worst.worst = 5;
    SegmentFilter period;
    period.period = Period{.from_ms = 1'765'000'000'000, .until_ms = {}};
    for (const auto& filter : {SegmentFilter{}, worst, period}) {
        const auto values = values_of(original, filter);
        EXPECT_THAT(values, Not(IsEmpty()));
        EXPECT_EQ(values_of(reader, filter), values);
    }
    EXPECT_EQ(reader.history({1, true, 3}).size(), original.history({1, true, 3}).size());
    EXPECT_EQ(reader.waiting(), original.waiting());
    EXPECT_EQ(reader.network_hash(), original.network_hash());
}

TEST_F(StoreCopies, RefuseWhatTheyCannotTake) {
    make_rich_store(file_);
    EXPECT_THAT(refusal_of([&] { copy_to_server(file_, server_.address(), {}, {}); }),
                HasSubstr("has no PostGIS"));
    EXPECT_THAT(refusal_back(), HasSubstr("has no road database: 'macadam copy roads.gpkg "));
    copy_there();
    EXPECT_THAT(refusal_there(), HasSubstr("already has a schema macadam"));
    EXPECT_THAT(refusal_of([&] { copy_from_server(address_, file_, {}); }),
                HasSubstr("roads.gpkg: already exists"));
    change("INSERT INTO macadam.migration VALUES (99, 'future')");
    EXPECT_THAT(refusal_back(),
                HasSubstr(fmt::format("its schema is of version 99, expected {}: it was made by a "
                                      "newer version of Macadam",
                                      server_schema_version)));
}

TEST_F(StoreCopies, LeaveNothingBehindWhenTheyFail) {
    make_rich_store(file_);
    const auto by_superuser = server_.address("roads");
    ServerConnection{by_superuser}.run(
        "CREATE FUNCTION refuse() RETURNS event_trigger LANGUAGE"
        " plpgsql AS $$BEGIN RAISE EXCEPTION 'no view today'; END$$");
    ServerConnection{by_superuser}.run("CREATE EVENT TRIGGER refused ON ddl_command_end WHEN TAG IN"
                                       " ('CREATE VIEW') EXECUTE FUNCTION refuse()");
    EXPECT_THAT(refusal_there(), HasSubstr("no view today"));
    EXPECT_EQ(one("SELECT count(*) FROM pg_namespace WHERE nspname = 'macadam'"), "0");
}

TEST_F(StoreCopies, DoNotTrustTheServer) {
    make_rich_store(file_);
    copy_there();
    const std::vector<std::pair<std::string, std::string>> changes{
        {"UPDATE macadam.drive SET body = '\\x01ff'", "the packed passes of a drive are invalid"},
        {"UPDATE macadam.drive SET body = ''", "the packed passes of a drive are invalid"},
        {"UPDATE macadam.meta SET value = '1e9' WHERE key = 'segment_length_m'",
         "segment_length_m is '1e9'"},
        {"UPDATE macadam.meta SET value = 'all' WHERE key = 'privacy'", "its settings are not"},
        {"UPDATE macadam.segment SET geom = 'SRID=4326;LINESTRING EMPTY'::public.geometry",
         "has no line"},
        {"ALTER TABLE macadam.event ALTER at_mm TYPE text", "an unexpected value of column 7"},
        {"DROP TABLE macadam.event", "relation \"macadam.event\" does not exist"}};
    for (const auto& [sql, words] : changes) {
        ServerConnection{server_.address()}.run("DROP DATABASE IF EXISTS changed");
        ServerConnection{server_.address()}.run("CREATE DATABASE changed TEMPLATE roads");
        const auto changed = server_.address("changed");
        ServerConnection{changed}.run(sql);
        EXPECT_THAT(refusal_of([&] { copy_from_server(changed, folder_ / "back.gpkg", {}); }),
                    HasSubstr(words))
            << sql;
        EXPECT_FALSE(fs::exists(folder_ / "back.gpkg"));
    }
}

TEST_F(StoreCopies, GiveReadersRoadsAndValuesButNoTrips) {
    make_rich_store(file_);
    const auto boss = server_.address("roads");
    EXPECT_TRUE(copy_to_server(file_, boss, {}, {}).by_superuser);
    ServerConnection{boss}.run("CREATE ROLE guest LOGIN IN ROLE macadam_reader; CREATE ROLE driver"
                               " LOGIN IN ROLE macadam_importer; CREATE ROLE nobody_ LOGIN");
    ServerConnection guest{server_.address("roads", "guest")};
    EXPECT_GT(guest.number("SELECT count(*) FROM macadam.roughness"), 0);
    for (const auto* const table : {"trip", "vehicle", "drive", "event", "pass", "audit"}) {
        EXPECT_THAT(refusal_of([&] {
                        guest.number(fmt::format("SELECT count(*) FROM macadam.{}", table));
                    }),
                    HasSubstr("permission denied"))
            << table;
    }
    EXPECT_THAT(refusal_of([&] {
                    copy_from_server(server_.address("roads", "guest"), folder_ / "b.gpkg", {});
                }),
                AllOf(HasSubstr("permission denied"), HasSubstr("grants macadam_operator")));
    EXPECT_THAT(refusal_of([&] {
                    copy_from_server(server_.address("roads", "nobody_"), folder_ / "b.gpkg", {});
                }),
                HasSubstr("permission denied for schema macadam"));
    EXPECT_GT(guest.number("SELECT count(chunk) FROM macadam.chunk_dirty"), 0);
    EXPECT_THAT(refusal_of([&] { guest.number("SELECT count(trip) FROM macadam.chunk_dirty"); }),
                HasSubstr("permission denied"));
    ServerConnection driver{server_.address("roads", "driver")};
    driver.run("INSERT INTO macadam.vehicle (pseudonym) VALUES ('v-new')");
    for (const auto* const sql : {"DELETE FROM macadam.forgotten",
                                  "DELETE FROM macadam.trip",
                                  "UPDATE macadam.trip SET vehicle = NULL",
                                  "DELETE FROM macadam.event",
                                  "UPDATE macadam.drive SET body = ''",
                                  "UPDATE macadam.audit SET what = ''"}) {
        EXPECT_THAT(refusal_of([&] { driver.run(sql); }), HasSubstr("permission denied")) << sql;
    }
}

TEST_F(StoreCopies, NameWhyTheyCannotConnectAndNoPassword) {
    make_rich_store(file_);
    for (const std::string address : {"postgresql://me:s3cret@127.0.0.1/roads",
                                      "postgresql://me@127.0.0.1/roads?password=s3cret",
                                      "postgresql://me:s3cret@127.0.0.1:port/roads?what=ever"}) {
        EXPECT_THAT(refusal_of([&] { copy_to_server(file_, address, {}, {}); }),
                    AllOf(HasSubstr("the address of the database"), Not(HasSubstr("s3cret"))));
    }
    EXPECT_THAT(
        refusal_of([&] { copy_to_server(file_, "postgresql://me@127.0.0.1:1/roads", {}, {}); }),
        AllOf(HasSubstr("cannot connect"), HasSubstr("Connection refused")));
    EXPECT_THAT(refusal_of([&] { copy_to_server(file_, server_.address("nowhere"), {}, {}); }),
                HasSubstr("database \"nowhere\" does not exist"));
    EXPECT_THAT(refusal_of([&] { copy_to_server(file_, server_.address("roads", "who"), {}, {}); }),
                HasSubstr("role \"who\" does not exist"));
}

TEST_F(StoreCopies, AreUpgradedByASuperuserForTheirOwner) {
    make_rich_store(file_);
    const auto digest = copy_there().digest;
    change("DROP TABLE macadam.announced_log, macadam.published_state, macadam.published_until,"
           " macadam.published_pending, macadam.published_figure, macadam.published_event,"
           " macadam.publication; DELETE FROM macadam.migration WHERE number > 6");
    ServerConnection by_superuser{server_.address("roads")};
    EXPECT_EQ(upgrade_server_schema(by_superuser), 6);
    EXPECT_EQ(by_superuser.number("SELECT count(*) FROM pg_class"
                                  " WHERE relnamespace = 'macadam'::regnamespace"
                                  " AND relowner <> 'owner'::regrole"),
              0);
    EXPECT_EQ(copy_from_server(address_, folder_ / "back.gpkg", {}).digest, digest);
}

} // namespace
} // namespace macadam
