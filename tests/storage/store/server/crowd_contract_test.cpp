// What a database of a crowd does on any engine: the same sentences, tried on a GeoPackage and on
// PostgreSQL, beside a file of the same key.

#include "mapping/conflation/network_conflation.hpp"
#include "storage/jobs/job_queue.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/store/rows/known_trips.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/replica/server_replica.hpp"
#include "support/files/files.hpp"
#include "support/program/places.hpp"
#include "support/program/program.hpp"
#include "support/program/shell.hpp"
#include "support/roads/crowd_drives.hpp"
#include "support/roads/engine_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

constexpr int road_count = 8;

StoreSettings of(PrivacyProfile privacy) {
    StoreSettings settings;
    settings.network_source = "map";
    settings.privacy = privacy;
    return settings;
}

std::vector<std::optional<SegmentState>> values_of(const StoreReader& store,
                                                   const std::optional<Period>& period = {}) {
    SegmentFilter filter;
    filter.period = period;
    std::vector<std::optional<SegmentState>> states;
    store.visit(filter, [&](const SegmentRecord& record) {
        if (record.state) {
            states.push_back(record.state);
        }
    });
    return states;
}

class CrowdOnAnyEngine : public ::testing::TestWithParam<Engine> {
protected:
    /// Makes the database, and the file beside it.
    void make(PrivacyProfile privacy = PrivacyProfile::crowd) {
        database_.emplace(GetParam(), folder_, roads_in_a_row(road_count), of(privacy));
        fs::copy_file(folder_ / "roads.gpkg", oracle_);
        fs::copy_file(key_file_of(folder_ / "roads.gpkg"), key_file_of(oracle_));
    }

    /// Cars 0 to `cars` - 1 drive; the file takes their trips in the opposite order.
    void drive(int cars, std::int64_t utc_ms, IriUm iri_um = 2000, bool holes = false) {
        std::vector<CrowdDrive> drives;
        for (int car = 0; car < cars; ++car) {
            drives.push_back({trips_++, car, utc_ms, iri_um, holes, road_count});
        }
        import(drives);
        fuse();
    }

    /// One car drives the first roads, and is not fused.
    void drive_first_roads(int car, std::int64_t utc_ms, int roads) {
        import({{ trips_++, car, utc_ms, 9000, false, roads }});
    }

    void import(const std::vector<CrowdDrive>& drives) {
        const auto file = import_store_of(RoadStore::open(oracle_));
        const auto database = database_->import();
        for (const auto& each : drives) {
            add(*database.trips, each);
        }
        for (auto each = drives.rbegin(); each != drives.rend(); ++each) {
            add(*file.trips, *each);
        }
    }

    void fuse() {
        fuse_all(*database_->import().trips);
        fuse_all(*import_store_of(RoadStore::open(oracle_)).trips);
    }

    /// Both publish.
    Published publish(std::int64_t now_ms) {
        const auto roads = roads_in_a_row(road_count);
        const auto in_file = RoadStore::open(oracle_).maintenance.publish(roads, now_ms);
        const auto done = database_->to_publish().maintenance.publish(roads, now_ms);
        EXPECT_EQ(done.changed, in_file.changed);
        EXPECT_EQ(done.publication, in_file.publication);
        return done;
    }

    void forget(const std::string& car) {
        const ForgetRequest request{.trips = {}, .vehicles = {car}};
        const auto in_file = RoadStore::open(oracle_).maintenance.forget(request);
        EXPECT_EQ(database_->forget(request).passes, in_file.passes);
    }

    /// The public and the operator see what they see of the file.
    void expect_as_in_file(const std::string& when) {
        const auto shown = database_->read(Audience::anyone);
        const auto expected = StoreReader::open(oracle_);
        EXPECT_TRUE(shown.shows_published_alone()) << when;
        EXPECT_EQ(values_of(shown), values_of(expected)) << when;
        for (const auto& month : {Period{january_ms, february_ms},
                                  Period{february_ms, march_ms},
                                  Period{january_ms, april_ms}}) {
            EXPECT_EQ(values_of(shown, month), values_of(expected, month)) << when;
        }
        EXPECT_EQ(shown.events({}).size(), expected.events({}).size()) << when;
        EXPECT_EQ(shown.digest(), expected.digest()) << when;
        EXPECT_EQ(shown.info().trips, expected.info().trips) << when;
        EXPECT_EQ(database_->read().digest(),
                  StoreReader::open(oracle_, {}, Audience::operator_).digest())
            << when;
    }

    fs::path folder_ = test_folder();
    fs::path oracle_ = folder_ / "oracle.gpkg";
    std::optional<EngineDatabase> database_;

private:
    static void add(ImportTarget& trips, const CrowdDrive& drive) {
        const auto record = drive.record();
        const auto passes = drive.passes();
        const auto events = drive.events();
        const NewTrip trip{&record, passes, {}, false, events};
        trips.add_trips({&trip, 1});
    }

    int trips_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Engines,
                         CrowdOnAnyEngine,
                         ::testing::Values(Engine::geopackage, Engine::postgresql),
                         [](const auto& engine) { return name_of(engine.param); });

TEST_P(CrowdOnAnyEngine, ShowsThePublicItsPublicationsAlone) {
    make();
    drive(6, january_ms, 2000, true);
    EXPECT_THAT(values_of(database_->read(Audience::anyone)), IsEmpty());
    EXPECT_FALSE(database_->read(Audience::anyone).latest_publication());
    const auto first = publish(february_ms);
    EXPECT_EQ(first.publication.vehicles, 5);
    EXPECT_EQ(first.changed, 60U); // all but the first and the last road
    expect_as_in_file("first");
    const auto shown = database_->read(Audience::anyone);
    EXPECT_THAT(values_of(shown), SizeIs(60));
    EXPECT_THAT(shown.events({}), SizeIs(1));
    EXPECT_THAT(shown.history({2, true, 3}), IsEmpty());
    EXPECT_THAT(shown.audit(), IsEmpty());
    EXPECT_THAT(shown.info().vehicles, IsEmpty());
    ASSERT_TRUE(shown.latest_publication());
    EXPECT_EQ(shown.latest_publication()->month, "2026-02");

    drive(6, february_ms, 5000); // stays out
    expect_as_in_file("later trips");
    EXPECT_EQ(values_of(database_->read(Audience::anyone)).front()->iri_um, 2000);
    EXPECT_EQ(publish(march_ms).publication.number, 2);
    expect_as_in_file("second");
}

TEST_P(CrowdOnAnyEngine, ShowsWhoHasTheKeyAll) {
    make();
    drive(2, january_ms);
    EXPECT_THAT(values_of(database_->read()), SizeIs(80));
    EXPECT_THAT(database_->read().info().vehicles, SizeIs(2));
    fs::remove(database_->key_file());
    const auto reader = database_->read();
    EXPECT_TRUE(reader.shows_published_alone());
    EXPECT_THAT(values_of(reader), IsEmpty());
}

TEST_P(CrowdOnAnyEngine, PublishesWhatAFileWouldThoughCarsAreForgotten) {
    make();
    drive(7, january_ms, 2000);
    drive(3, february_ms, 9000); // wait
    publish(february_ms);
    expect_as_in_file("first");
    const auto before = values_of(database_->read(Audience::anyone));
    forget("car 2");
    expect_as_in_file("forgotten");
    EXPECT_EQ(values_of(database_->read(Audience::anyone)), before); // until others drove
    drive(6, march_ms, 4000, true);
    publish(march_ms);
    expect_as_in_file("second");
    forget("car 0"); // of the trips that wait, too
    drive(6, march_ms + day_ms, 3000);
    publish(april_ms);
    expect_as_in_file("third");
    EXPECT_NE(values_of(database_->read(Audience::anyone)), before);
}

TEST_P(CrowdOnAnyEngine, PublishesWhatAFileWouldThoughTheRowOfItsLastTripIsTakenAgain) {
    make();
    drive(6, january_ms);
    drive_first_roads(9, january_ms, 2);
    fuse();
    publish(february_ms);
    forget("car 9"); // the last trip; later ones get its row on all roads
    expect_as_in_file("forgotten");
    drive(6, february_ms, 5000);
    publish(march_ms);
    expect_as_in_file("second");
    forget("car 3");
    drive(6, march_ms, 3000);
    publish(april_ms);
    expect_as_in_file("third");
}

TEST_P(CrowdOnAnyEngine, LeavesMarksOfOtherRoadsWhenACarIsForgotten) {
    make();
    drive(6, january_ms);
    drive_first_roads(9, january_ms, 2);
    drive_first_roads(8, january_ms, 5); // marks five roads
    forget("car 9");
    // What it drove is fused; in a file, all.
    EXPECT_EQ(database_->import().trips->waiting(), GetParam() == Engine::postgresql ? 30U : 0U);
    fuse();
    expect_as_in_file("fused");
    forget("car 8");
    expect_as_in_file("none of both");
    EXPECT_THAT(database_->read().info().vehicles, SizeIs(6));
}

TEST_P(CrowdOnAnyEngine, ForgetsATripByTheNameOfItsFile) {
    make();
    drive(6, january_ms);
    const auto drive = CrowdDrive{0, 0, january_ms, 2000, false, road_count}.record();
    const ForgetRequest request{.trips = {drive.file_name}, .vehicles = {}};
    EXPECT_EQ(RoadStore::open(oracle_).maintenance.forget(request).trips, 1U);
    EXPECT_EQ(database_->forget(request).trips, 1U);
    expect_as_in_file("forgotten");
    EXPECT_THAT(refusal_of([&] { database_->forget(request); }), HasSubstr("has no trip"));
}

TEST_P(CrowdOnAnyEngine, IsPublishedOnceAMonthByWhoHasTheKey) {
    make();
    drive(6, january_ms);
    publish(february_ms);
    const auto refusal = [&] {
        return refusal_of([&] {
            database_->to_publish().maintenance.publish(roads_in_a_row(road_count), february_ms);
        });
    };
    EXPECT_THAT(refusal(),
                HasSubstr("was already published in 2026-02, and can be published once"));
    const auto key_file = database_->key_file();
    fs::remove(key_file);
    EXPECT_THAT(refusal(), HasSubstr("its key is not at " + key_file.string()));
    EXPECT_FALSE(fs::exists(key_file));
}

TEST_P(CrowdOnAnyEngine, MayHaveBeenOneOfOwnCars) {
    make(PrivacyProfile::own);
    drive(6, january_ms, 2000, true);
    EXPECT_FALSE(database_->read(Audience::anyone).shows_published_alone());
    const auto old_import = database_->import();
    const auto in_file = RoadStore::open(oracle_).maintenance.make_crowd();
    const auto made = database_->maintain().maintenance.make_crowd();
    EXPECT_EQ(made.trips, 6U);
    EXPECT_EQ(made.passes, in_file.passes);
    EXPECT_GT(made.passes, 0U);
    expect_as_in_file("crowd");
    EXPECT_THAT(values_of(database_->read()), Not(IsEmpty()));
    EXPECT_THAT(refusal_of([&] { add_rich_trip(*old_import.trips, 1); }),
                HasSubstr("in the meantime; nothing was written, run the command again"));
    drive(6, february_ms);
    publish(march_ms);
    expect_as_in_file("published");
    EXPECT_THAT(refusal_of([&] { database_->maintain().maintenance.make_crowd(); }),
                HasSubstr("is already a crowd database"));
}

void drive_in_january(const EngineDatabase& database, int cars) {
    const auto store = database.import();
    for (int car = 0; car < cars; ++car) {
        const CrowdDrive drive{car, car, january_ms, 2000, true, road_count};
        const auto record = drive.record();
        const auto passes = drive.passes();
        const auto events = drive.events();
        const NewTrip trip{&record, passes, {}, false, events};
        store.trips->add_trips({&trip, 1});
    }
    fuse_all(*store.trips);
}

TEST(CrowdOnAServer, GoesThereAndBackWithItsPublications) {
    const auto folder = test_folder();
    EngineDatabase database{
        Engine::postgresql, folder, roads_in_a_row(road_count), of(PrivacyProfile::crowd)};
    drive_in_january(database, 7);
    database.maintain().maintenance.publish(roads_in_a_row(road_count), february_ms);
    const auto back = folder / "back.gpkg";
    const auto copied = copy_from_server(database.name(), back, {});
    const auto there = database.server().new_database("again");
    EXPECT_EQ(copy_to_server(back, there, {}, {}).digest, copied.digest);
    const auto again = folder / "again.gpkg";
    EXPECT_EQ(copy_from_server(there, again, {}).digest, copied.digest);
    EXPECT_EQ(rows_of_tables(again), rows_of_tables(back));
    EXPECT_THAT(rows_of_tables(back),
                AllOf(Contains(StartsWith("published_state|")),
                      Contains(StartsWith("published_until|")),
                      Contains(StartsWith("published_figure|")),
                      Contains(StartsWith("published_event|"))));
    for (const auto& file : {back, again}) { // and goes on from there, with its key
        auto store = RoadStore::open(file);
        EXPECT_EQ(store.maintenance.publish(roads_in_a_row(road_count), march_ms).changed, 0U);
    }
}

/// Takes a forgotten trip out again, as after a restore. \returns what the script said.
std::string
forget_again(const fs::path& folder, const EngineDatabase& database, const std::string& sha256) {
    write_file(folder / "forgotten.txt", forgotten_mark(sha256) + "\n");
    return output_of(folder,
                     fmt::format("psql -X '{}' -f {}/packaging/cluster/forget_listed.sql < {}",
                                 database.name(),
                                 source_folder(),
                                 (folder / "forgotten.txt").string()));
}

TEST(CrowdOnAServer, LosesForgottenTripsThatWaitToBePublishedAgainAfterARestore) {
    const auto folder = test_folder();
    EngineDatabase database{
        Engine::postgresql, folder, roads_in_a_row(road_count), of(PrivacyProfile::crowd)};
    drive_in_january(database, 3);
    ServerConnection server{database.name()};
    server.run("INSERT INTO macadam.published_pending (segment, trip, occurrence)"
               " SELECT (SELECT min(fid) FROM macadam.segment), id, 0 FROM macadam.trip");
    const auto trip = server.rows("SELECT id, sha256 FROM macadam.trip ORDER BY id LIMIT 1").at(0);
    EXPECT_THAT(forget_again(folder, database, trip[1].value_or("")),
                AllOf(HasSubstr("COMMIT"), Not(HasSubstr("ERROR")), Not(HasSubstr("calibrate"))));
    EXPECT_EQ(server.number("SELECT count(*) FROM macadam.trip"), 2);
    EXPECT_EQ(server.number("SELECT count(*) FROM macadam.published_pending"), 2);
    fuse_all(*database.import().trips);
    EXPECT_THAT(values_of(database.read()), Not(IsEmpty()));
}

TEST(CrowdOnAServer, LosesLogsOfForgottenTripsAgainAfterARestore) {
    const auto folder = test_folder();
    EngineDatabase database{
        Engine::postgresql, folder, roads_in_a_row(road_count), of(PrivacyProfile::crowd)};
    drive_in_january(database, 2);
    ServerConnection server{database.name()};
    server.run("INSERT INTO macadam.job (sha256, suffix, bytes, owner, state, has_object)"
               " SELECT repeat(digit, 64), '.zip', 1, 'anna', 'imported', false"
               " FROM (VALUES ('a'), ('b')) AS log (digit);" // an archive of each trip
               " INSERT INTO macadam.job_trip SELECT trip.sha256, job.sha256, true FROM macadam.job"
               " JOIN macadam.trip ON trip.id = job.number;"
               " INSERT INTO macadam.job (sha256, suffix, bytes)" // also waits as it is
               " SELECT sha256, '.trip.csv', 1 FROM macadam.trip WHERE id = 1;"
               " UPDATE macadam.trip SET calibrates = 1");
    ASSERT_EQ(server.number("SELECT count(*) FROM macadam.job_trip"), 2);
    const auto trip =
        server.rows("SELECT sha256 FROM macadam.trip WHERE id = 1").at(0)[0].value_or("");
    EXPECT_THAT(forget_again(folder, database, trip),
                AllOf(HasSubstr("COMMIT"),
                      Not(HasSubstr("ERROR")),
                      HasSubstr("Cars were calibrated from 1 of these trips: run 'macadam "
                                "calibrate' on the database")));
    EXPECT_EQ(server.number("SELECT count(*) FROM macadam.job_trip"), 1);
    std::vector<std::string> leaving; // workers erase these, wherever they still are
    for (const auto& job : jobs_to_erase(server, 10, ErasedLogs::forgotten)) {
        leaving.push_back(job.sha256);
    }
    EXPECT_THAT(leaving, UnorderedElementsAre(std::string(64, 'a'), trip));
    EXPECT_EQ(server.number("SELECT count(*) FROM macadam.job WHERE state = 'imported'"), 1);
}

TEST(CrowdOnAServer, UsesNoRowOfASegmentTwice) {
    EngineDatabase database{
        Engine::postgresql, test_folder(), roads_in_a_row(3), of(PrivacyProfile::crowd)};
    database.maintain().maintenance.publish(roads_in_a_row(3), february_ms);
    for (const auto& [before, after] : {std::pair{3, 2}, std::pair{2, 3}}) {
        const auto old_roads = roads_in_a_row(before);
        const auto roads = roads_in_a_row(after);
        database.maintain().maintenance.update_network(
            old_roads, roads, change_between(old_roads, roads), {"newer map", ""});
    }
    ServerConnection server{database.name()};
    EXPECT_EQ(server.number("SELECT count(*) FROM macadam.segment"), 60);
    EXPECT_EQ(server.number("SELECT min(fid) FROM macadam.segment WHERE way_id = 3"),
              1 + server.number("SELECT last_segment FROM macadam.publication"));
}

TEST(CrowdOnAServer, FetchesOnlyTheRoadsThatAForgottenCarDrove) {
    EngineDatabase database{
        Engine::postgresql, test_folder(), roads_in_a_row(road_count), of(PrivacyProfile::crowd)};
    const auto store = database.import();
    for (int car = 0; car < 4; ++car) {
        const CrowdDrive drive{car, car, january_ms, 2000, false, car == 3 ? 2 : road_count};
        const auto record = drive.record();
        const auto passes = drive.passes();
        const NewTrip trip{&record, passes, {}, false, {}};
        store.trips->add_trips({&trip, 1});
    }
    fuse_all(*store.trips);
    const auto whole = database.read().info();
    const ForgetRequest request{.trips = {}, .vehicles = {"car 3"}};
    RoadStore part{open_replica_to_forget(database.name(), request, {}, {})};
    EXPECT_EQ(part.info().segments_with_passes, 20U);
    EXPECT_EQ(part.info().passes, 80U); // of all four cars there
    EXPECT_EQ(part.maintenance.forget(request).passes, 20U);
    const auto left = database.read().info();
    EXPECT_EQ(left.segments_with_passes, whole.segments_with_passes);
    EXPECT_EQ(left.passes, whole.passes - 20);
}

TEST(CrowdOnAServer, GetsNoKeyThatItsCopiesTakeAway) {
    EngineDatabase database{
        Engine::postgresql, test_folder(), roads_in_a_row(road_count), of(PrivacyProfile::own)};
    const auto key_file = database.key_file();
    fs::remove(key_file);
    EXPECT_THAT(refusal_of([&] { database.maintain().maintenance.make_crowd(); }),
                HasSubstr("the key of its cars is not at " + key_file.string()));
    EXPECT_EQ(database.read().settings().privacy, PrivacyProfile::own);
}

} // namespace
} // namespace macadam::testing
