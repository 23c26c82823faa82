// Operations on a database whose cells lie on two servers: prepared everywhere, then switched.

#include "mapping/conflation/network_conflation.hpp"
#include "mapping/network/build_network.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/importer/server_importer.hpp"
#include "storage/store/server/replica/server_replica.hpp"
#include "support/program/lost_standby.hpp"
#include "support/roads/cell_world.hpp"
#include "support/roads/edited_network.hpp"
#include "support/roads/fleet_passes.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;

class CellGenerations : public CellWorld {
protected:
    /// Imports trips of a fleet, whose car 0 reads too high, to the front, and to a file like it.
    RoadStore import_fleet() {
        constexpr int fleet_trips = 30;
        auto file = RoadStore::create(folder_ / "file.gpkg", border_country(), settings());
        for (const auto& open : {import_store_of(file).trips, open_server_import(front_).trips}) {
            for (int number = 0; number < fleet_trips; ++number) {
                const auto record = trip_record(number);
                auto passes = passes_of_fleet(number);
                for (std::size_t i = 0; i < passes.size(); ++i) {
                    passes[i].segment.way_id = i % 2 == 0 ? 1 : 5; // on both servers
                }
                const NewTrip trip{&record, passes, {}, false, {}};
                open->add_trips({&trip, 1});
            }
            fuse_all(*open);
        }
        return file;
    }

    /// Does as an operator what is done to a file.
    void expect_work_of_operators(RoadStore file) {
        const ForgetRequest one{.trips = {trip_record(4).sha256}, .vehicles = {}};
        const std::vector<SegmentKey> resurfaced{{1, true, 2}};
        constexpr std::int64_t from_ms = 1'765'000'000'000;
        const auto before = digest();
        RoadStore{open_replica_to_forget(chief_, one, {}, {})}.maintenance.forget(one);
        EXPECT_NE(digest(), before);
        RoadStore{open_server_replica(chief_, {}, {})}.maintenance.calibrate();
        RoadStore{open_server_replica(chief_, {}, {})}.maintenance.set_valid_from(
            resurfaced, from_ms, {});
        file.maintenance.forget(one);
        file.maintenance.calibrate();
        file.maintenance.set_valid_from(resurfaced, from_ms, {});
        EXPECT_EQ(digest(), file.digest());
    }
};

TEST_F(CellGenerations, SwitchToAGenerationThatIsPreparedEverywhere) {
    import(0, 6);
    spread();
    auto file = RoadStore::create(folder_ / "file.gpkg", border_country(), settings());
    import_border_trips(file, 0, 6);
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
    import_border_trips(file, 6, 8);
    EXPECT_EQ(digest(), file.digest());
}

TEST_F(CellGenerations, AreInDoubtUntilTheStandbyOfEachServerHasThem) {
    import(0, 3);
    spread();
    auto file = RoadStore::create(folder_ / "file.gpkg", border_country(), settings());
    import_border_trips(file, 0, 3);
    const auto maintain = [](RoadStore store) {
        store.maintenance.set_valid_from(
            std::vector<SegmentKey>{{1, true, 2}, {6, true, 5}}, 1'765'000'000'000, {});
    };
    const auto boss = east_server_.address("east");
    lose_standby(boss);
    EXPECT_THAT(
        while_waits_are_cancelled(boss,
                                  [&] {
                                      return refusal_of([&] {
                                          maintain(RoadStore{open_server_replica(front_, {}, {})});
                                      });
                                  }),
        HasSubstr("a server of its cells warns"));
    need_no_standby(boss);
    maintain(RoadStore{open_server_replica(front_, {}, {})}); // again, as it was asked for
    maintain(file);
    EXPECT_EQ(digest(), file.digest());
}

TEST_F(CellGenerations, AreCalibratedAsAFileIs) {
    spread();
    auto file = import_fleet();
    const auto before = digest();
    ASSERT_EQ(before, file.digest());
    file.maintenance.calibrate();
    RoadStore{open_server_replica(front_, {}, {})}.maintenance.calibrate();
    EXPECT_NE(digest(), before);
    EXPECT_EQ(digest(), file.digest());
    const ForgetRequest request{.trips = {trip_record(2).sha256}, .vehicles = {}};
    EXPECT_TRUE(file.maintenance.forget(request).calibrated);
    EXPECT_TRUE(RoadStore{open_replica_to_forget(front_, request, {}, {})}
                    .maintenance.forget(request)
                    .calibrated);
    EXPECT_EQ(digest(), file.digest());
}

TEST_F(CellGenerations, AreOfThoseCellsAloneThatForgottenTripsDrove) {
    import(0, 2);
    spread();
    auto file = RoadStore::create(folder_ / "file.gpkg", border_country(), settings());
    import_border_trips(file, 0, 2);
    const RichTrip one{7}; // over way 1
    for (const auto& open : {import_store_of(file).trips, open_server_import(front_).trips}) {
        const auto trip = one.as_new();
        open->add_trips({&trip, 1});
        fuse_all(*open);
    }
    ServerConnection front{front_};
    const auto numbers = [&] {
        return front.numbers("SELECT number FROM macadam.cell_place ORDER BY cell");
    };
    const auto before = numbers();
    const ForgetRequest request{.trips = {one.record.sha256}, .vehicles = {}};
    RoadStore{open_replica_to_forget(front_, request, {}, {})}.maintenance.forget(request);
    file.maintenance.forget(request);
    EXPECT_EQ(digest(), file.digest());
    const auto after = numbers();
    ASSERT_EQ(after.size(), numbers_.size());
    const auto driven =
        number(front_, "SELECT cell FROM macadam.segment WHERE way_id = '1' LIMIT 1");
    for (std::size_t i = 0; i < after.size(); ++i) {
        EXPECT_EQ(after[i] != before[i], numbers_[i] == driven) << i;
    }
}

TEST_F(CellGenerations, AreTheWorkOfOperators) {
    spread();
    expect_work_of_operators(import_fleet());
}

TEST_F(CellGenerations, NeedNoMoreRightsOnOneServer) {
    expect_work_of_operators(import_fleet());
}

TEST_F(CellGenerations, AreTheWorkOfOperatorsOnceTheOwnerOfAnEarlierFrontMovesACell) {
    spread();
    ServerConnection{front_}.run("DROP FUNCTION macadam.prepare_cell, macadam.note_filled,"
                                 " macadam.lost_cells, macadam.switch_cells,"
                                 " macadam.drop_unused_cell_tables;"
                                 "DROP FOREIGN TABLE macadam.filled_macadam_cells_1,"
                                 " macadam.filled_macadam_cells_2");
    auto file = import_fleet();
    EXPECT_THAT(
        refusal_of([&] { RoadStore{open_server_replica(chief_, {}, {})}.maintenance.calibrate(); }),
        HasSubstr("once the owner ran 'macadam cells"));
    EXPECT_EQ(digest(), file.digest());
    {
        ServerConnection owner{front_};
        EXPECT_EQ(move_cell(owner, numbers_.at(0), west_), 0);
    }
    expect_work_of_operators(file);
}

TEST_F(CellGenerations, MoveTheirPassesToANewerMapAsAFileDoes) {
    import(0, 6);
    spread();
    auto file = RoadStore::create(folder_ / "file.gpkg", border_country(), settings());
    import_border_trips(file, 0, 6);
    const auto roads = border_country();
    auto network = edited(copies_of_ways(roads));
    reverse(network, 2); // begins in the other server's cell, now
    renumber(network, 6, 60);
    const auto newer = build_network(ways_of(network), 20);
    const auto change = change_between(roads, newer);
    const auto update = [&](RoadStore store) {
        return store.maintenance.update_network(roads, newer, change, {"newer.osm", ""});
    };
    EXPECT_TRUE(update(file).changed);
    EXPECT_TRUE(update(RoadStore{open_server_replica(front_, {}, {})}).changed);
    EXPECT_EQ(digest(), file.digest());
    const auto one = RichTrip{7}; // over way 1
    for (const auto& open : {import_store_of(file).trips, open_server_import(front_).trips}) {
        const auto trip = one.as_new();
        open->add_trips({&trip, 1});
        fuse_all(*open);
    }
    EXPECT_EQ(digest(), file.digest());
    EXPECT_EQ(copy_from_server(front_, folder_ / "copy.gpkg", {}).digest, file.digest());
}

TEST_F(CellGenerations, AreSwitchedBetweenReadersWithoutMakingOthersWait) {
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

} // namespace
} // namespace macadam::testing
