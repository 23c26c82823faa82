// A database whose cells lie on two servers, with roads across their border.

#include "storage/store/server/cells/cell_moves.hpp"

#include "mapping/network/build_network.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/store/server/cells/cell_drives.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/importer/server_importer.hpp"
#include "storage/store/server/reader/server_reader.hpp"
#include "storage/store/server/replica/server_replica.hpp"
#include "support/files/files.hpp"
#include "support/program/lost_standby.hpp"
#include "support/program/postgres_server.hpp"
#include "support/roads/engine_world.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <future>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

namespace macadam::testing {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;

constexpr std::int64_t ways = 7;

/// Seven roads of 200 m in a row around the corner of four map tiles of zoom 8, three of them
/// across a border:
///
///     8--7 : 6--5
///     ... .:... |
///     1--2-:-3--4
RoadNetwork border_country() {
    constexpr double lat_deg = 46.073230625408644, lon_deg = 3 * 360.0 / 256;
    constexpr double high_deg = 200.2 / 111'195, wide_deg = high_deg / 0.693;
    const auto at = [&](double x, double y) {
        return GeoPoint{lat_deg + y * high_deg, lon_deg + x * wide_deg};
    };
    const std::vector<GeoPoint> corners{at(-1.5, -0.5),
                                        at(-0.5, -0.5),
                                        at(0.5, -0.5),
                                        at(1.5, -0.5),
                                        at(1.5, 0.5),
                                        at(0.5, 0.5),
                                        at(-0.5, 0.5),
                                        at(-1.5, 0.5)};
    std::vector<Way> roads;
    for (std::int64_t number = 1; number <= ways; ++number) {
        const auto first = corners.begin() + (number - 1);
        Way way{.id = number,
                .name = "",
                .highway = "residential",
                .node_ids = {number, number + 1},
                .line = {first[0], first[1]}};
        roads.push_back(way);
    }
    return build_network(std::move(roads), 20);
}

/// Trip over all roads, there and back.
struct BorderTrip {
    explicit BorderTrip(int number) : record{RichTrip{number}.record} {
        const RichTrip one{number};
        for (std::int64_t way = 1; way <= ways; ++way) {
            for (auto pass : one.passes) {
                pass.segment.way_id = way;
                passes.push_back(pass);
            }
            for (auto trace : one.traces) {
                trace.chunk.way_id = way;
                traces.push_back(trace);
            }
            for (auto event : one.events) {
                event.segment.way_id = way;
                events.push_back(event);
            }
        }
    }

    NewTrip as_new() const { return {&record, passes, traces, false, events}; }

    TripRecord record;
    std::vector<Pass> passes;
    std::vector<RoughnessTrace> traces;
    std::vector<PassEvent> events;
};

bool add(ImportTarget& trips, int number) {
    const BorderTrip trip{number};
    const auto one = trip.as_new();
    return trips.add_trips({&one, 1}).front();
}

/// Adds trips to a file and fuses them.
void import_into(const RoadStore& file, int first, int past) {
    const auto open = import_store_of(file);
    for (int number = first; number < past; ++number) {
        add(*open.trips, number);
    }
    fuse_all(*open.trips);
}

class Cells : public ::testing::Test {
protected:
    void SetUp() override {
        static_cast<void>(RoadStore::create(folder_ / "roads.gpkg", border_country(), settings()));
        copy_to_server(folder_ / "roads.gpkg", front_, {}, {});
        ServerConnection boss{boss_};
        for (const auto& cell : cells_of(boss)) {
            numbers_.push_back(cell.number);
        }
        ASSERT_EQ(numbers_.size(), 4U);
    }

    std::string digest_of_file(int trips) {
        auto store = RoadStore::create(folder_ / "file.gpkg", border_country(), settings());
        import_into(store, 0, trips);
        return store.digest();
    }

    std::string digest() const {
        return StoreReader{open_server_reader(front_, {}, Audience::operator_, {}, {})}.digest();
    }

    std::int64_t move(std::size_t cell, const std::string& to) {
        ServerConnection boss{boss_};
        return move_cell(boss, numbers_.at(cell), to);
    }

    /// Moves the western cells to one server, the eastern ones to the other.
    void spread() {
        for (std::size_t cell = 0; cell < numbers_.size(); ++cell) {
            move(cell, cell % 2 == 0 ? west_ : east_);
        }
    }

    void import(int first, int past) {
        const auto open = open_server_import(front_);
        for (int number = first; number < past; ++number) {
            EXPECT_TRUE(add(*open.trips, number));
        }
        fuse_all(*open.trips);
    }

    std::int64_t number(const std::string& address, const std::string& sql) {
        return ServerConnection{address}.number(sql);
    }

    /// The address as clients of a cluster have it, whose first server is down.
    static std::string with_a_standby(std::string address) {
        return address.replace(
            address.find("?host="), 6, "?target_session_attrs=read-write&host=/nowhere,");
    }

    std::filesystem::path folder_ = test_folder();
    PostgresServer east_server_;
    PostgresServer server_; // keys and roads are kept there
    std::string front_ = server_.new_database("front");
    std::string boss_ = server_.address("front");
    std::string west_ = with_a_standby(server_.new_database("west"));
    std::string east_ = east_server_.new_database("east");
    std::vector<std::int32_t> numbers_; ///< north-west, north-east, south-west, south-east
};

TEST_F(Cells, OnTwoServersFuseRoadsAcrossTheirBorderAsOnOne) {
    constexpr int trips = 6;
    import(0, 2);
    EXPECT_GT(move(1, east_), 0);
    EXPECT_EQ(move(1, east_), 0);
    spread();
    import(2, trips);

    const auto drives_in = [&](const std::string& address) {
        ServerConnection server{address};
        std::int64_t drives = 0;
        for (const auto& row : server.rows("SELECT relname FROM pg_class WHERE relkind = 'r'"
                                           " AND relname ~ '^drive_\\d+_\\d+$'")) {
            drives += server.number("SELECT count(*) FROM macadam." + *row[0]);
        }
        return drives;
    };
    EXPECT_EQ(drives_in(west_), 6 * trips); // three roads, both ways
    EXPECT_EQ(drives_in(east_), 8 * trips);
    EXPECT_EQ(number(front_, "SELECT count(*) FROM macadam.unfinished"), 0);
    EXPECT_EQ(digest(), digest_of_file(trips));
    const auto copy = copy_from_server(front_, folder_ / "back.gpkg", {});
    EXPECT_EQ(copy.digest, digest());
    ServerConnection boss{boss_};
    const auto cells = cells_of(boss);
    EXPECT_THAT(cells.at(0).connection, HasSubstr("dbname='west'"));
    EXPECT_THAT(cells.at(1).connection, HasSubstr("dbname='east'"));

    EXPECT_GT(move(0, boss_), 0); // and back
    EXPECT_EQ(digest(), copy.digest);
    EXPECT_EQ(drives_in(west_), 4 * trips);
}

TEST_F(Cells, MoveToAnotherServerWhileTripsAreImported) {
    constexpr int trips = 12;
    spread();
    const auto third = server_.new_database("third");
    const auto fourth = east_server_.new_database("fourth");
    std::atomic<bool> is_importing = true;
    std::vector<std::future<void>> importers;
    for (int importer = 0; importer < 2; ++importer) {
        importers.push_back(std::async(std::launch::async, [&, importer] {
            const auto open = open_server_import(front_);
            for (int number = importer; number < trips; number += 2) {
                EXPECT_TRUE(add(*open.trips, number));
                fuse_all(*open.trips);
            }
        }));
    }
    auto reading = std::async(std::launch::async, [&] {
        for (int read = 0; is_importing; ++read) { // each copy proves its digest
            copy_from_server(front_, folder_ / ("read" + std::to_string(read) + ".gpkg"), {});
        }
    });
    move(0, third);
    move(1, fourth);
    EXPECT_GT(move(2, third), 0);
    EXPECT_GT(move(2, west_), 0);
    for (auto& importer : importers) {
        importer.get();
    }
    is_importing = false;
    reading.get();
    import(trips, trips);
    EXPECT_EQ(digest(), digest_of_file(trips));
}

TEST_F(Cells, HaveEachTripOnceThoughImportersAndServersAreKilled) {
    constexpr int trips = 40, kills = 6;
    const auto expected = digest_of_file(trips);
    spread();
    std::mt19937 random{22};
    const auto import_until_killed = [&] { // starts a process that imports what is missing
        const auto child = fork();
        if (child == 0) {
            try {
                const auto open = open_server_import(front_);
                for (int number = 0; number < trips; ++number) {
                    if (!open.trips->contains_trip(trip_record(number).sha256)) {
                        add(*open.trips, number);
                    }
                    if (number % 4 == 0) {
                        fuse_all(*open.trips);
                    }
                }
            } catch (const std::exception&) {
                _exit(1); // a server is gone
            }
            _exit(0);
        }
        return child;
    };
    int ended_alone = 0;
    for (int kill_number = 0; kill_number < kills; ++kill_number) {
        const auto child = import_until_killed();
        ASSERT_GT(child, 0);
        std::this_thread::sleep_for(std::chrono::milliseconds{60 + random() % 250});
        if (kill_number % 3 == 0) {
            kill(child, SIGKILL);
        } else {
            (kill_number % 3 == 1 ? east_server_ : server_).kill_and_restart();
        }
        int status = 0;
        ASSERT_EQ(waitpid(child, &status, 0), child);
        ended_alone += WIFEXITED(status) && WEXITSTATUS(status) == 0 ? 1 : 0;
    }
    EXPECT_LT(ended_alone, kills) << "no kill met an import";
    const auto open = open_server_import(front_);
    for (int number = 0; number < trips; ++number) {
        add(*open.trips, number); // again: what is there stays
    }
    fuse_all(*open.trips);
    EXPECT_EQ(digest(), expected);

    // What the kills left on the servers goes with the next import.
    ServerConnection{boss_}.run("UPDATE macadam.unfinished SET at = at - interval '1 hour'");
    ServerConnection front{front_};
    remove_unfinished(front);
    EXPECT_EQ(number(front_, "SELECT count(*) FROM macadam.unfinished"), 0);
    EXPECT_EQ(number(front_, "SELECT count(*) FROM macadam.drive"), 2 * ways * trips);
    EXPECT_EQ(digest(), expected);
}

TEST_F(Cells, CountDrivesOnlyOfTripsThatTheFrontHas) {
    import(0, 2);
    move(1, east_);
    const auto before = digest();
    ServerConnection front{front_};
    front.run("INSERT INTO macadam.drive SELECT cell, chunk, 1000, drive, passes, body, first_m,"
              " place_sd_mm, iri, iri_left FROM macadam.drive WHERE trip = 1 AND cell ="
              " (SELECT cell FROM macadam.cell_place);"
              "INSERT INTO macadam.unfinished VALUES (1000, now() - interval '1 hour');"
              "INSERT INTO macadam.chunk_dirty SELECT DISTINCT chunk, 0, 0 FROM macadam.drive");
    fuse_all(*open_server_import(front_).trips);
    EXPECT_EQ(digest(), before);
    EXPECT_EQ(copy_from_server(front_, folder_ / "copy.gpkg", {}).digest, before);
    open_server_import(front_).trips->begin_import("next", 0);
    EXPECT_EQ(front.number("SELECT count(*) FROM macadam.drive WHERE trip = 1000"), 0);
    EXPECT_EQ(front.number("SELECT count(*) FROM macadam.unfinished"), 0);
}

TEST_F(Cells, SayThatATripIsInDoubtUntilTheStandbyOfACellHasIt) {
    move(3, east_);
    const auto boss = east_server_.address("east");
    ServerConnection east{boss};
    lose_standby(boss);
    const auto open = open_server_import(front_);
    auto first =
        std::async(std::launch::async, [&] { return refusal_of([&] { add(*open.trips, 0); }); });
    const auto waiting = " FROM pg_stat_activity WHERE " + waits_for_standby;
    while (east.number("SELECT count(*)" + waiting) == 0) { // the test's time limit ends it
        std::this_thread::sleep_for(std::chrono::milliseconds{10});
    }
    EXPECT_EQ(east.number("SELECT count(pg_cancel_backend(pid))" + waiting), 1);
    EXPECT_THAT(
        first.get(),
        AllOf(HasSubstr("a server of its cells warns"), HasSubstr("run the command again")));
    EXPECT_EQ(number(front_, "SELECT count(*) FROM macadam.trip"), 0);
    need_no_standby(boss);
    EXPECT_TRUE(add(*open.trips, 0));
    fuse_all(*open.trips);
    EXPECT_EQ(digest(), digest_of_file(1));
}

TEST_F(Cells, SwitchToAGenerationThatIsPreparedEverywhere) {
    import(0, 6);
    spread();
    auto file = RoadStore::create(folder_ / "file.gpkg", border_country(), settings());
    import_into(file, 0, 6);
    const auto before = digest();
    ASSERT_EQ(before, file.digest());
    const std::vector<SegmentKey> resurfaced{{1, true, 2}, {2, false, 9}, {6, true, 5}};
    const auto maintain = [&](RoadStore store) {
        store.maintenance.set_valid_from(resurfaced, 1'765'000'000'000, {});
    };

    // One server takes no commit: nothing changes on any.
    ServerConnection east{east_};
    east.run("CREATE FUNCTION macadam.refuse() RETURNS trigger LANGUAGE plpgsql AS"
             " $$ BEGIN IF current_setting('application_name') = 'postgres_fdw' THEN"
             " RAISE EXCEPTION 'no room'; END IF; RETURN NULL; END $$;"
             "CREATE FUNCTION macadam.refuse_commits() RETURNS event_trigger LANGUAGE plpgsql AS"
             " $$ DECLARE t text; BEGIN FOR t IN SELECT object_identity FROM"
             " pg_event_trigger_ddl_commands() WHERE object_identity ~ 'segment_state_' AND"
             " object_type = 'table' LOOP EXECUTE format('CREATE CONSTRAINT TRIGGER refuse AFTER"
             " DELETE OR INSERT ON %s DEFERRABLE INITIALLY DEFERRED FOR EACH ROW EXECUTE FUNCTION"
             " macadam.refuse()', t); END LOOP; END $$");
    ServerConnection{east_server_.address("east")}.run(
        "CREATE EVENT TRIGGER refuse_commits ON ddl_command_end WHEN TAG IN ('CREATE TABLE')"
        " EXECUTE FUNCTION macadam.refuse_commits()");
    EXPECT_THAT(refusal_of([&] { maintain(RoadStore{open_server_replica(front_, {}, {})}); }),
                HasSubstr("no room"));
    EXPECT_EQ(digest(), before);
    ServerConnection{east_server_.address("east")}.run("DROP EVENT TRIGGER refuse_commits");

    maintain(RoadStore{open_server_replica(front_, {}, {})});
    maintain(file);
    EXPECT_NE(digest(), before);
    EXPECT_EQ(digest(), file.digest());
    for (const auto& address : {west_, east_}) { // what was replaced is gone
        EXPECT_EQ(number(address,
                         "SELECT count(*) FROM pg_class WHERE relkind = 'r' AND relname ~"
                         " '^(drive|segment_state)_\\d+_\\d+$'"),
                  4);
    }
    import(6, 8);
    import_into(file, 6, 8);
    EXPECT_EQ(digest(), file.digest());
}

TEST_F(Cells, AreSwitchedBetweenReadersWithoutMakingOthersWait) {
    import(0, 4);
    spread();
    auto reader = std::make_unique<ServerConnection>(front_);
    reader->begin(true);
    reader->number("SELECT count(*) FROM macadam.drive"); // and reads on
    auto done = std::async(std::launch::async, [&] {
        RoadStore{open_server_replica(front_, {}, {})}.maintenance.set_valid_from(
            std::vector<SegmentKey>{{1, true, 2}}, 1'765'000'000'000, {});
    });
    const std::string waiting = "SELECT count(*) FROM pg_locks WHERE NOT granted AND relation IS"
                                " NOT NULL AND mode = 'AccessExclusiveLock'";
    while (number(front_, waiting) == 0 &&
           done.wait_for(std::chrono::milliseconds{10}) == std::future_status::timeout) {
    }
    EXPECT_GT(number(front_, "SELECT count(*) FROM macadam.drive"), 0); // beside both
    EXPECT_EQ(done.wait_for(std::chrono::milliseconds{0}), std::future_status::timeout);
    reader.reset();
    done.get();
}

TEST_F(Cells, AreMovedByThoseOnlyWhoMay) {
    const auto refusal = [&](const std::string& by, std::int32_t cell, const std::string& to) {
        return refusal_of([&] {
            ServerConnection front{by};
            move_cell(front, cell, to);
        });
    };
    EXPECT_THAT(refusal(front_, numbers_.at(0), west_),
                HasSubstr("only a superuser of this server adds another one"));
    EXPECT_THAT(refusal(front_, 3, west_), HasSubstr("has no cell 3"));
    EXPECT_THAT(refusal(boss_, numbers_.at(0), front_), HasSubstr("already has a schema macadam"));
    move(0, west_);
    ServerConnection owner{front_};
    move_cell(owner, numbers_.at(1), west_); // known by now
    EXPECT_THAT(cells_of(owner).at(1).connection, HasSubstr("dbname='west'"));
}

TEST_F(Cells, KeepTheirAddressesFromTheOwnerOfTheRoads) {
    move(0, west_);
    for (const auto* const change :
         {"UPDATE macadam_cells.address SET connection = 'dbname=front user=boss'",
          "CREATE OR REPLACE FUNCTION macadam_cells.connection_of(server text) RETURNS text"
          " LANGUAGE sql AS $$ SELECT 'dbname=front user=boss' $$",
          "DROP TABLE macadam_cells.address CASCADE",
          "CREATE FUNCTION macadam.own(server text) RETURNS bigint LANGUAGE plproxy AS"
          " $$ CONNECT 'dbname=front user=boss'; $$"}) {
        EXPECT_THAT(refusal_of([&] { ServerConnection{front_}.run(change); }),
                    AnyOf(HasSubstr("permission denied"), HasSubstr("must be owner")))
            << change;
    }
}

} // namespace
} // namespace macadam::testing
