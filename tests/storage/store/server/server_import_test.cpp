// Many workers that import into one PostgreSQL server and fuse there.

#include "storage/store/server/importer/server_importer.hpp"

#include "storage/postgres/server_connection.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/reader/server_reader.hpp"
#include "storage/store/server/replica/server_replica.hpp"
#include "support/files/files.hpp"
#include "support/program/lost_standby.hpp"
#include "support/roads/engine_world.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <future>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class ServerImports : public ::testing::Test {
protected:
    std::string file_digest(int trips) {
        auto store = new_store(folder_ / "file.gpkg");
        import_rich_trips(*import_store_of(store).trips, trips);
        return store.digest();
    }

    /// Waits until some other connection waits for something of this kind.
    void await_waiter(const std::string& what) {
        ServerConnection boss{database_.server().address("roads")};
        while (boss.number("SELECT count(*) FROM pg_stat_activity WHERE " + what) == 0) {
            std::this_thread::sleep_for(std::chrono::milliseconds{10}); // the time limit ends it
        }
    }

    std::int64_t number(const std::string& sql) {
        return ServerConnection{database_.name()}.number(sql);
    }

    std::filesystem::path folder_ = test_folder();
    EngineDatabase database_{Engine::postgresql, folder_};
};

/// Trips first .. past - 1, each twice, in an order of their own, by four workers who fuse in
/// between. \returns how many were new.
int deliver(const std::string& address, int first, int past, unsigned order) {
    constexpr std::size_t workers = 4;
    std::vector<int> deliveries;
    for (int number = first; number < past; ++number) {
        deliveries.insert(deliveries.end(), {number, number});
    }
    std::ranges::shuffle(deliveries, std::mt19937{order});
    std::vector<std::future<int>> added;
    for (std::size_t worker = 0; worker < workers; ++worker) {
        added.push_back(std::async(std::launch::async, [&, worker] {
            const auto open = open_server_import(address);
            int fresh = 0;
            for (std::size_t i = worker; i < deliveries.size(); i += workers) {
                fresh += add_rich_trip(*open.trips, deliveries[i]) ? 1 : 0;
                if (i % 3 == 0) {
                    fuse_all(*open.trips);
                }
            }
            fuse_all(*open.trips);
            return fresh;
        }));
    }
    int fresh = 0;
    for (auto& worker : added) {
        fresh += worker.get();
    }
    return fresh;
}

TEST_F(ServerImports, ByFourWorkersWhoAreGivenEachTripTwiceHaveTheDigestOfAFileInEachGeneration) {
    const bool all = std::getenv("MACADAM_TEST_ALL") != nullptr; // NOLINT(concurrency-mt-unsafe)
    const unsigned orders = all ? 20 : 2;
    constexpr int generations = 3, trips = 8; // in each
    auto file = new_store(folder_ / "file.gpkg");
    std::vector<std::string> expected;
    for (int generation = 0; generation < generations; ++generation) {
        const auto open = import_store_of(file);
        for (int number = generation * trips; number < (generation + 1) * trips; ++number) {
            add_rich_trip(*open.trips, number);
        }
        fuse_all(*open.trips);
        expected.push_back(file.digest());
        file.maintenance.calibrate();
    }
    for (unsigned order = 0; order < orders; ++order) {
        const auto name = "b" + std::to_string(order);
        const auto address = database_.server().new_database(name);
        static_cast<void>(new_store(folder_ / (name + ".gpkg")));
        copy_to_server(folder_ / (name + ".gpkg"), address, {}, {});
        for (int generation = 0; generation < generations; ++generation) {
            EXPECT_EQ(deliver(address, generation * trips, (generation + 1) * trips, order), trips);
            EXPECT_EQ(ServerConnection{address}.number("SELECT count(*) FROM macadam.chunk_dirty"),
                      0);
            const StoreReader reader{open_server_reader(address, {}, Audience::operator_, {}, {})};
            EXPECT_EQ(reader.digest(), expected[static_cast<std::size_t>(generation)]) << order;
            RoadStore{open_server_replica(address, {}, {})}.maintenance.calibrate();
        }
        const StoreReader reader{open_server_reader(address, {}, Audience::operator_, {}, {})};
        EXPECT_EQ(reader.digest(), file.digest()) << order;
        EXPECT_EQ(reader.info().trips, static_cast<std::size_t>(generations * trips));
        EXPECT_EQ(reader.info().vehicles.size(), 3U);
    }
}

TEST_F(ServerImports, NeverWorkByRoadsAndSettingsThatAnotherServerGave) {
    const auto other = database_.server().new_database("other");
    static_cast<void>(new_store(folder_ / "other.gpkg"));
    copy_to_server(folder_ / "other.gpkg", other, {}, {});
    static_cast<void>(database_.import());
    ServerConnection{other}.run("UPDATE macadam.meta SET value = 'crowd' WHERE key = 'privacy'");
    ServerConnection{other}.rows(
        "UPDATE macadam.meta SET value = $1 WHERE key = 'network_rows'",
        {ServerConnection{database_.name()}
             .rows("SELECT value FROM macadam.meta WHERE key = 'network_rows'")
             .at(0)
             .at(0)});
    EXPECT_EQ(open_server_import(other).image->settings.privacy, PrivacyProfile::crowd);
    EXPECT_EQ(open_server_import(database_.name()).image->settings.privacy, PrivacyProfile::own);
}

TEST_F(ServerImports, BesideWhoMaintainsTheDatabaseHaveTheDigestOfAFile) {
    constexpr int trips = 18;
    const std::vector<SegmentKey> resurfaced{{1, true, 2}, {1, false, 5}};
    const auto maintain = [&](RoadStore store) {
        store.maintenance.set_valid_from(resurfaced, 1'765'000'000'000, {});
        RichTrip again{0};
        for (auto& pass : again.passes) {
            pass.iri_um += 300;
        }
        EXPECT_TRUE(stage_trip(store, again.record, again.passes, again.traces, again.events));
        store.maintenance.commit_staged("method smoother");
    };
    add_rich_trip(*database_.import().trips, 0);
    std::vector<std::future<void>> workers;
    for (int worker = 0; worker < 3; ++worker) {
        workers.push_back(std::async(std::launch::async, [&, worker] {
            const auto open = open_server_import(database_.name());
            for (int number = worker; number < trips; number += 3) {
                add_rich_trip(*open.trips, number);
                fuse_all(*open.trips);
            }
        }));
    }
    maintain(database_.maintain());
    for (auto& worker : workers) {
        worker.get();
    }
    fuse_all(*database_.import().trips);

    auto file = new_store(folder_ / "file.gpkg");
    import_rich_trips(*import_store_of(file).trips, trips);
    maintain(file);
    EXPECT_EQ(database_.read().digest(), file.digest());
}

TEST_F(ServerImports, LoseNoMarkThatIsSetWhileAChunkIsFused) {
    const auto store = database_.import();
    add_rich_trip(*store.trips, 0);
    ServerConnection holder{database_.name()};
    holder.begin(false);
    holder.run("LOCK TABLE macadam.chunk_change IN SHARE MODE"); // which fusion writes in the end
    auto fusing = std::async(std::launch::async, [&] { fuse_all(*store.trips); });
    await_waiter("wait_event_type = 'Lock' AND query LIKE '%chunk_change%'");
    add_rich_trip(*database_.import().trips, 1);
    holder.commit();
    fusing.get();
    EXPECT_EQ(number("SELECT count(*) FROM macadam.chunk_dirty"), 2);
    fuse_all(*store.trips);
    EXPECT_EQ(number("SELECT count(*) FROM macadam.chunk_dirty"), 0);
    EXPECT_EQ(database_.read().digest(), file_digest(2));
}

TEST_F(ServerImports, WaitForNobodyWhoDrivesOverTheSameRoads) {
    const auto store = database_.import();
    add_rich_trip(*store.trips, 0);
    ServerConnection other{database_.name()};
    other.begin(false); // as a trip that waits for its standby: an end after this one
    other.run("INSERT INTO macadam.chunk_dirty (chunk, trip, since_ms)"
              " SELECT chunk, 1000, 0 FROM macadam.chunk_dirty");
    add_rich_trip(*store.trips, 1);
    fuse_all(*store.trips);
    EXPECT_EQ(number("SELECT count(*) FROM macadam.chunk_dirty"), 0);
    other.commit();
    EXPECT_EQ(number("SELECT count(*) FROM macadam.chunk_dirty"), 2);
}

TEST_F(ServerImports, FindAllThatTheyLookUpByIndexes) {
    const std::string tables = "^(drive|segment_state)_\\d+$|^(trip|vehicle|forgotten|chunk_dirty"
                               "|chunk_state|chunk_change|state_change|event|event_search"
                               "|row_reason|audit|valid_from)$";
    import_rich_trips(*database_.import().trips, 2);
    const auto before = database_.scans_of(tables);
    ASSERT_GE(before.size(), 14U);
    {
        const auto store = database_.import();
        for (int number = 2; number < 40; ++number) {
            add_rich_trip(*store.trips, number);
        }
        fuse_all(*store.trips);
        add_rich_trip(*store.trips, 5); // known
        EXPECT_TRUE(store.trips->contains_trip(RichTrip{5}.record.sha256));
        EXPECT_FALSE(store.trips->has_forgotten(RichTrip{5}.record.sha256));
    }
    EXPECT_EQ(database_.scans_of(tables), before);
}

TEST_F(ServerImports, SayThatATripIsInDoubtUntilItsStandbyHasIt) {
    const auto boss = database_.server().address("roads");
    const auto store = database_.import();
    lose_standby(boss);
    auto first = std::async(std::launch::async,
                            [&] { return refusal_of([&] { add_rich_trip(*store.trips, 1); }); });
    await_waiter(waits_for_standby);
    ServerConnection{boss}.number(
        "SELECT count(pg_cancel_backend(pid)) FROM pg_stat_activity WHERE " + waits_for_standby);
    EXPECT_THAT(first.get(), AllOf(HasSubstr("in doubt"), HasSubstr("run the command again")));

    // The server has it, but "known" is not said before the standby does.
    auto again = std::async(std::launch::async, [&] { return add_rich_trip(*store.trips, 1); });
    await_waiter(waits_for_standby);
    EXPECT_EQ(again.wait_for(std::chrono::milliseconds{100}), std::future_status::timeout);
    need_no_standby(boss);
    EXPECT_FALSE(again.get());
    EXPECT_TRUE(store.trips->contains_trip(trip_record(1).sha256));
}

TEST_F(ServerImports, WaitForWhoWorksOnTheWholeDatabase) {
    const auto store = database_.import();
    std::future<bool> added;
    {
        const RoadStore alone{open_server_replica(database_.name(), {}, {})};
        added = std::async(std::launch::async, [&] { return add_rich_trip(*store.trips, 1); });
        await_waiter("wait_event = 'advisory'");
        EXPECT_EQ(number("SELECT count(*) FROM macadam.trip"), 0);
    }
    EXPECT_TRUE(added.get());
}

TEST_F(ServerImports, RefuseToGoOnOverOtherRoads) {
    const auto store = database_.import();
    ServerConnection{database_.name()}.run(
        "UPDATE macadam.meta SET value = gen_random_uuid()::text WHERE key = 'network_rows'");
    EXPECT_THAT(
        refusal_of([&] { add_rich_trip(*store.trips, 1); }),
        HasSubstr("its roads or its key were changed in the meantime; nothing was written"));
    EXPECT_EQ(number("SELECT count(*) FROM macadam.trip"), 0);
    EXPECT_TRUE(add_rich_trip(*database_.import().trips, 1));
}

TEST_F(ServerImports, NeedTheKeyOfTheCars) {
    const auto key = database_.import().trips->key_file();
    ASSERT_TRUE(std::filesystem::remove(key));
    EXPECT_THAT(refusal_of([&] { add_rich_trip(*database_.import().trips, 1); }),
                AllOf(HasSubstr("the key of its cars is not at " + key.string()),
                      HasSubstr("copy it there from")));
}

TEST_F(ServerImports, WriteNothingOnceWorkersHaveOtherResults) {
    const auto old = open_server_import(database_.name(), {}, 1);
    EXPECT_TRUE(add_rich_trip(*old.trips, 0)); // no worker has decided
    ServerConnection workers{database_.name()};
    const auto decide = [&](const std::string& version) {
        workers.rows("INSERT INTO macadam.work_setting VALUES ('results_version', $1)"
                     " ON CONFLICT (key) DO UPDATE SET value = excluded.value",
                     {version});
    };
    decide("1");
    EXPECT_TRUE(add_rich_trip(*old.trips, 1));
    decide("2");
    const auto refusal =
        AllOf(HasSubstr("its workers compute results of version 2, this program those of version "
                        "1"),
              HasSubstr("macadam worker --take-over"));
    EXPECT_THAT(refusal_of([&] { add_rich_trip(*old.trips, 2); }), refusal);
    EXPECT_THAT(refusal_of([&] { fuse_all(*old.trips); }), refusal);
    EXPECT_THAT(refusal_of([&] { open_server_import(database_.name(), {}, 1); }), refusal);
    EXPECT_EQ(number("SELECT count(*) FROM macadam.trip"), 2);
    const auto now = open_server_import(database_.name(), {}, 2);
    EXPECT_TRUE(add_rich_trip(*now.trips, 2));
    fuse_all(*now.trips);
    EXPECT_EQ(database_.read().digest(), file_digest(3));
}

TEST_F(ServerImports, AreWrittenByTheRoleOfAnImporter) {
    PostgresServer server;
    ServerConnection{server.address()}.run("CREATE ROLE macadam_importer NOLOGIN;"
                                           "CREATE ROLE driver LOGIN IN ROLE macadam_importer");
    const auto file = folder_ / "role.gpkg";
    static_cast<void>(RoadStore::create(file, small_country(), settings()));
    const auto address = server.new_database("roads");
    copy_to_server(file, address, {}, {});
    const auto open = open_server_import(server.address("roads", "driver"));
    open.trips->begin_import("a", 3);
    import_rich_trips(*open.trips, 3);
    open.trips->end_import("a");
    EXPECT_FALSE(add_rich_trip(*open.trips, 1)); // known
    EXPECT_EQ(StoreReader{open_server_reader(address, {}, Audience::operator_, {}, {})}.digest(),
              file_digest(3));
}

} // namespace
} // namespace macadam::testing
