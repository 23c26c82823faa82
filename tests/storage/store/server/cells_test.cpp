// A database whose cells lie on two servers, with roads across their border.

#include "storage/store/server/cells/cell_moves.hpp"

#include "storage/postgres/server_connection.hpp"
#include "storage/store/server/cells/cell_drives.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/importer/server_importer.hpp"
#include "storage/store/server/reader/chunk_choice.hpp"
#include "support/program/lost_standby.hpp"
#include "support/roads/cell_world.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstddef>
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
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

class Cells : public CellWorld {
protected:
    static constexpr std::int64_t drives_of_first_cell = 2; // of each trip, there and back

    /// Drives in tables of cells on a server, and in those that the front uses no more.
    static std::int64_t drives_in(const std::string& address) {
        ServerConnection server{address};
        std::int64_t drives = 0;
        for (const auto& row : server.rows("SELECT relname FROM pg_class WHERE relkind = 'r'"
                                           " AND relname ~ '^drive_\\d+_\\d+$'")) {
            drives += server.number("SELECT count(*) FROM macadam." + *row[0]);
        }
        return drives;
    }
};

TEST_F(Cells, OnTwoServersFuseRoadsAcrossTheirBorderAsOnOne) {
    constexpr int trips = 6;
    import(0, 2);
    EXPECT_GT(move(1, east_), 0);
    EXPECT_EQ(move(1, east_), 0);
    spread();
    import(2, trips);

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

TEST_F(Cells, AreAskedOnceForEachChunkThatIsRead) {
    import(0, 1);
    spread();
    const auto scans_of_states = [&] {
        ServerConnection east{east_};
        while (east.number("SELECT count(*) FROM pg_stat_activity WHERE backend_type = 'client"
                           " backend' AND pid <> pg_backend_pid()") > 0) { // they tell at their end
            std::this_thread::sleep_for(std::chrono::milliseconds{10});
        }
        return east.number("SELECT sum(seq_scan + idx_scan)::bigint FROM pg_stat_user_tables WHERE"
                           " relname ~ '^segment_state_'");
    };
    const auto before = scans_of_states();
    std::size_t chunks_read = 0, segments = 0;
    {
        SegmentFilter eastern_road;
        eastern_road.way_id = 4;
        ServerConnection reader{front_};
        ServerTransaction one_moment{reader, true};
        const auto chunks = chunks_for(reader, eastern_road);
        chunks_read = chunks.size();
        const StoreReader part{
            open_server_part(reader, chunks, {.passes = false}, Audience::operator_, {}, {})};
        part.visit({}, [&](const SegmentRecord&) { ++segments; });
    }
    ASSERT_EQ(chunks_read, 2U); // there and back
    ASSERT_EQ(segments, 20U);
    constexpr std::int64_t ends_of_period = 2, cells_there = 2;
    EXPECT_LE(scans_of_states() - before,
              static_cast<std::int64_t>(chunks_read) + ends_of_period * cells_there);
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
                EXPECT_TRUE(add_border_trip(*open.trips, number));
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
                        add_border_trip(*open.trips, number);
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
        add_border_trip(*open.trips, number); // again: what is there stays
    }
    fuse_all(*open.trips);
    EXPECT_EQ(digest(), expected);

    // What the kills left on the servers goes with the next import.
    ServerConnection{boss_}.run("UPDATE macadam.unfinished SET at = at - interval '1 hour'");
    ServerConnection front{front_};
    remove_unfinished(front);
    EXPECT_EQ(number(front_, "SELECT count(*) FROM macadam.unfinished"), 0);
    EXPECT_EQ(number(front_, "SELECT count(*) FROM macadam.drive"), 2 * border_ways * trips);
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
    auto first = std::async(std::launch::async,
                            [&] { return refusal_of([&] { add_border_trip(*open.trips, 0); }); });
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
    EXPECT_TRUE(add_border_trip(*open.trips, 0));
    fuse_all(*open.trips);
    EXPECT_EQ(digest(), digest_of_file(1));
}

TEST_F(Cells, GetNoDrivesBeforeTheStandbyOfTheFrontHasTheirNote) {
    move(3, east_);
    const auto open = open_server_import(front_);
    lose_standby(boss_);
    EXPECT_THAT(while_waits_are_cancelled(
                    boss_, [&] { return refusal_of([&] { add_border_trip(*open.trips, 0); }); }),
                HasSubstr("in doubt until its standby has it"));
    EXPECT_EQ(number(front_, "SELECT count(*) FROM macadam.drive"), 0);
    need_no_standby(boss_);
    EXPECT_TRUE(add_border_trip(*open.trips, 0));
    fuse_all(*open.trips);
    EXPECT_EQ(digest(), digest_of_file(1));
}

TEST_F(Cells, FuseAgainWhatTheStandbyOfACellMayLack) {
    move(3, east_);
    const auto open = open_server_import(front_);
    EXPECT_TRUE(add_border_trip(*open.trips, 0));
    const auto boss = east_server_.address("east");
    lose_standby(boss);
    EXPECT_THAT(
        while_waits_are_cancelled(boss, [&] { return refusal_of([&] { fuse_all(*open.trips); }); }),
        AllOf(HasSubstr("a server of its cells warns"), HasSubstr("run the command again")));
    EXPECT_GT(number(front_, "SELECT count(*) FROM macadam.chunk_dirty"), 0);
    need_no_standby(boss);
    fuse_all(*open.trips);
    EXPECT_EQ(number(front_, "SELECT count(*) FROM macadam.chunk_dirty"), 0);
    EXPECT_EQ(digest(), digest_of_file(1));
}

TEST_F(Cells, StayWhereTheyWereUntilTheStandbyOfTheirNewServerHasThem) {
    import(0, 2);
    move(1, east_); // the server is known by now
    const auto before = digest();
    const auto boss = east_server_.address("east");
    for (const auto& from : {boss_, west_}) {
        move(0, from);
        lose_standby(boss);
        EXPECT_THAT(
            while_waits_are_cancelled(boss, [&] { return refusal_of([&] { move(0, east_); }); }),
            AllOf(HasSubstr("a server of its cells warns"), HasSubstr("run the command again")));
        EXPECT_EQ(drives_in(from), drives_of_first_cell * 2) << from;
        EXPECT_EQ(digest(), before);
        need_no_standby(boss);
        EXPECT_EQ(move(0, east_), 0);
        EXPECT_EQ(drives_in(from), 0) << from;
        EXPECT_EQ(digest(), before);
    }
}

TEST_F(Cells, StayOnOtherServersUntilTheStandbyOfTheFrontHasThem) {
    import(0, 2);
    move(0, east_);
    const auto before = digest();
    lose_standby(boss_);
    for (int attempt = 0; attempt < 2; ++attempt) { // the second one finds them here
        EXPECT_THAT(
            while_waits_are_cancelled(boss_, [&] { return refusal_of([&] { move(0, boss_); }); }),
            HasSubstr("in doubt until its standby has it"));
        EXPECT_EQ(drives_in(east_), drives_of_first_cell * 2) << attempt;
    }
    need_no_standby(boss_);
    EXPECT_EQ(move(0, boss_), 0);
    EXPECT_EQ(drives_in(east_), 0);
    EXPECT_EQ(digest(), before);
}

TEST_F(Cells, StayWhereTheyWereIfTheirNewServerLostThemInAFailover) {
    import(0, 2);
    move(0, west_);
    move(1, east_);
    const auto boss = east_server_.address("east");
    lose_standby(boss);
    while_waits_are_cancelled(boss, [&] { return refusal_of([&] { move(0, east_); }); });
    need_no_standby(boss);
    const auto suffix =
        std::to_string(numbers_.at(0)) + "_" +
        std::to_string(number(front_,
                              "SELECT number FROM macadam.cell_place WHERE cell = " +
                                  std::to_string(numbers_.at(0))));
    ServerConnection{boss}.run( // the last transaction is gone, that before it made the tables
        "TRUNCATE macadam.drive_" + suffix + ", macadam.segment_state_" + suffix +
        "; DELETE FROM macadam.filled WHERE number = (SELECT max(number) FROM macadam.filled)");
    for (const auto& to : {east_, west_, boss_}) {
        EXPECT_THAT(refusal_of([&] { move(0, to); }),
                    HasSubstr("another server lost the rows that it got of cell " +
                              std::to_string(numbers_.at(0))))
            << to;
    }
    EXPECT_EQ(drives_in(west_), drives_of_first_cell * 2);
}

TEST_F(Cells, ExplainEveryObjectOfTheirFront) {
    move(0, west_);
    ServerConnection front{front_};
    for (const auto* const unexplained :
         {"SELECT relname FROM pg_class WHERE relnamespace = 'macadam'::regnamespace"
          " AND relkind IN ('r', 'p', 'v', 'f') AND obj_description(oid, 'pg_class') IS NULL",
          "SELECT relname || '.' || attname FROM pg_attribute JOIN pg_class"
          " ON pg_class.oid = attrelid WHERE relnamespace = 'macadam'::regnamespace AND relkind IN"
          " ('r', 'p', 'v', 'f') AND NOT relispartition AND attnum > 0 AND"
          " col_description(attrelid, attnum) IS NULL",
          "SELECT proname FROM pg_proc WHERE pronamespace = 'macadam'::regnamespace"
          " AND obj_description(oid, 'pg_proc') IS NULL"}) {
        const auto names = front.rows(unexplained);
        EXPECT_TRUE(names.empty()) << names.at(0)[0].value_or("");
    }
    EXPECT_EQ(front.number("SELECT count(*) FROM pg_class WHERE relkind = 'f'"), 3);
}

TEST_F(Cells, FuseOnAFrontOfAnEarlierVersionToo) {
    move(3, east_);
    ServerConnection{boss_}.run("DROP FUNCTION macadam.await_standby");
    import(0, 1);
    EXPECT_EQ(number(front_, "SELECT count(*) FROM macadam.chunk_dirty"), 0);
    EXPECT_EQ(digest(), digest_of_file(1));
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

TEST_F(Cells, OfAServerThatIsGoneWithoutAWordDoNotHoldTheFrontUpForLong) {
    move(0, west_);
    ServerConnection boss{boss_};
    const auto options =
        boss.rows("SELECT array_to_string(srvoptions, ' ') FROM pg_foreign_server");
    for (const auto& connection : {cells_of(boss).at(0).connection, options.at(0)[0].value()}) {
        EXPECT_THAT(connection, ContainsRegex("tcp_user_timeout='?20000"));
        EXPECT_THAT(connection, ContainsRegex("keepalives_idle='?10"));
    }
}

TEST_F(Cells, GoToAServerThatAnEarlierVersionKnewWithoutTimeLimits) {
    move(0, west_);
    ServerConnection boss{boss_};
    boss.run("UPDATE macadam_cells.address SET connection = regexp_replace("
             "connection, '(keepalives|tcp)\\w+=''\\d+'' ?', '', 'g')");
    move(1, west_);
    const auto cells = cells_of(boss);
    EXPECT_EQ(cells.at(1).connection, cells.at(0).connection);
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
