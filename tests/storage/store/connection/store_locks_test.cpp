// Who works on a store and who comes in between: nobody waits for longer than another one writes,
// and nobody loses what he did.

#include "storage/sqlite/lock_wait.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/road_store.hpp"
#include "support/files/files.hpp"
#include "support/program/fork.hpp"
#include "support/roads/fleet_passes.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <ostream>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using Clock = std::chrono::steady_clock;

constexpr int trips_before = 12;

std::string digest_of(const fs::path& file) {
    return StoreReader::open(file).digest();
}

// --------------------------------------------------------------------- upkeep beside who writes

/// A command of upkeep, as the library does it.
struct UpkeepCase {
    std::string name;
    std::function<void(RoadStore&)> prepare;
    std::function<void(RoadStore&, const Progress&)> work;
};

void PrintTo(const UpkeepCase& maintenance, std::ostream* out) {
    *out << maintenance.name;
}

void nothing(RoadStore& /*store*/) {}

void stage_some(RoadStore& store) {
    for (const int trip : {2, 5}) {
        stage_trip(store, trip_record(trip), passes_of_fleet(trip + 1), {});
    }
}

void set_valid_from(RoadStore& store, const Progress& progress) {
    const std::vector<SegmentKey> segments{{1, true, 3}, {1, false, 4}};
    store.maintenance.set_valid_from(segments, trip_record(5).t0_utc_ms, "resurfaced", progress);
}

std::vector<UpkeepCase> maintenances() {
    return {
        {"calibrate",
         nothing,
         [](RoadStore& store, const Progress& progress) { store.maintenance.calibrate(progress); }},
        {"forget",
         nothing,
         [](RoadStore& store, const Progress& progress) {
             store.maintenance.forget({.trips = {"trip-4"}, .vehicles = {}}, progress);
         }},
        {"forget_of_a_calibrated_fleet",
         [](RoadStore& store) { store.maintenance.calibrate(); },
         [](RoadStore& store, const Progress& progress) {
             store.maintenance.forget({.trips = {"trip-4"}, .vehicles = {}}, progress);
         }},
        {"valid_from", nothing, set_valid_from},
        {"reprocess",
         nothing,
         [](RoadStore& store, const Progress& progress) {
             stage_some(store);
             store.maintenance.commit_staged("anew", progress);
         }},
        {"reprocess_of_a_calibrated_fleet",
         [](RoadStore& store) { store.maintenance.calibrate(); },
         [](RoadStore& store, const Progress& progress) {
             stage_some(store);
             store.maintenance.commit_staged("anew", progress);
         }}};
}

class UpkeepBesideImports : public ::testing::TestWithParam<UpkeepCase> {};

/// Calls `act` when chunks begin to be fused beside the store, the first `times` times.
Progress at_each_begin(const std::function<void()>& act, int times) {
    return {.report =
                [act, left = times](std::size_t done, std::size_t) mutable {
                    if (done == 0 && left > 0) {
                        --left;
                        act();
                    }
                },
            .stop = {}};
}

TEST_P(UpkeepBesideImports, LetsTripsComeInWhileItWorksAndFusesThemByItsRules) {
    const auto folder = test_folder();
    auto store = fleet_store(folder / "a.gpkg", trips_before);
    GetParam().prepare(store);
    int came = 0;
    GetParam().work(store,
                    at_each_begin(
                        [&] { // some are fused already when it puts its work in place
                            auto other = RoadStore::open(folder / "a.gpkg");
                            add_of_fleet(other, 20);
                            other.importer.refresh();
                            add_of_fleet(other, 21);
                            came += 2;
                        },
                        1));
    EXPECT_EQ(came, 2); // before it ended: it held no lock
    store.importer.refresh();

    auto serial = fleet_store(folder / "b.gpkg", trips_before);
    GetParam().prepare(serial);
    GetParam().work(serial, {});
    add_of_fleet(serial, 20);
    add_of_fleet(serial, 21);
    serial.importer.refresh();
    EXPECT_EQ(store.digest(), serial.digest());
}

TEST_P(UpkeepBesideImports, BeginsAnewWhereAnotherUpkeepWasQuickerAndTheThirdTimeLocksItOut) {
    const auto folder = test_folder();
    auto store = fleet_store(folder / "a.gpkg", trips_before);
    GetParam().prepare(store);
    int others = 0;
    GetParam().work(store,
                    at_each_begin(
                        [&] {
                            auto other = RoadStore::open(folder / "a.gpkg");
                            const std::vector<SegmentKey> segment{
                                {1, true, static_cast<std::uint32_t>(others++)}};
                            other.maintenance.set_valid_from(segment, trip_record(8).t0_utc_ms, "");
                        },
                        2));
    EXPECT_EQ(others, 2);

    auto serial = fleet_store(folder / "b.gpkg", trips_before);
    GetParam().prepare(serial);
    for (const std::uint32_t index : {0U, 1U}) {
        serial.maintenance.set_valid_from(
            std::vector<SegmentKey>{{1, true, index}}, trip_record(8).t0_utc_ms, "");
    }
    GetParam().work(serial, {});
    EXPECT_EQ(store.digest(), serial.digest());
}

TEST_P(UpkeepBesideImports, LeavesNothingBehindWhenItIsStopped) {
    const auto folder = test_folder();
    auto store = fleet_store(folder / "a.gpkg", trips_before);
    GetParam().prepare(store);
    const auto before = store.digest();
    std::stop_source source;
    auto progress = at_each_begin([&] { source.request_stop(); }, 1);
    progress.stop = source.get_token();
    EXPECT_THAT(refusal_of([&] { GetParam().work(store, progress); }),
                HasSubstr("a.gpkg: interrupted; the database is unchanged"));
    EXPECT_EQ(store.digest(), before);
    GetParam().work(store, {}); // by the same connection: nothing of the first time is in its way

    auto serial = fleet_store(folder / "b.gpkg", trips_before);
    GetParam().prepare(serial);
    GetParam().work(serial, {});
    EXPECT_EQ(store.digest(), serial.digest());
}

INSTANTIATE_TEST_SUITE_P(Maintenance,
                         UpkeepBesideImports,
                         ::testing::ValuesIn(maintenances()),
                         [](const auto& test) { return test.param.name; });

TEST(Refresh, BesideAnotherThatAddsAndFusesTheSameChunksComesToTheSame) {
    const auto folder = test_folder();
    const auto file = folder / "a.gpkg";
    new_store(file);
    constexpr int trips = 24;
    const auto import_half = [&](int half) {
        auto store = RoadStore::open(file);
        for (int number = half; number < trips; number += 2) {
            add_of_fleet(store, number);
            store.importer.refresh();
        }
    };
    {
        const std::jthread one{import_half, 0};
        const std::jthread other{import_half, 1};
    }
    auto store = RoadStore::open(file);
    EXPECT_EQ(store.waiting(), 0U);
    EXPECT_EQ(store.digest(), fleet_store(folder / "b.gpkg", trips).digest());
}

// --------------------------------------------------------------------------- whom it waits for

enum class Journal { rollback, log };

/// A process that holds the lock of the file until this goes. To be made while this process has the
/// file not open: SQLite bears no fork.
class Holder {
public:
    /// \param does  what the process does once it holds it.
    Holder(const fs::path& file, Journal journal, const std::function<void()>& does) {
        int to_parent[2];
        EXPECT_EQ(::pipe(to_parent), 0);
        process_ = fork_without_threads();
        if (process_ == 0) {
            Database database{file, Database::Access::write};
            if (journal == Journal::log) {
                database.enable_wal();
            }
            const Transaction held{database, Transaction::Kind::write};
            [[maybe_unused]] const auto told = ::write(to_parent[1], "x", 1);
            does();
            database.run("ROLLBACK");
            database.close();
            ::_exit(0);
        }
        char word = 0;
        EXPECT_EQ(::read(to_parent[0], &word, 1), 1);
        ::close(to_parent[0]);
        ::close(to_parent[1]);
    }
    Holder(const Holder&) = delete;
    Holder& operator=(const Holder&) = delete;
    ~Holder() {
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }

    int process() const { return process_; }

private:
    pid_t process_ = 0;
};

void stand_still() {
    while (true) {
        ::pause();
    }
}

void work_for(Clock::duration time) {
    for (const auto end = Clock::now() + time; Clock::now() < end;) {
    }
}

fs::path file_of_a_table() {
    auto file = test_folder() / "a.db";
    Database{file, Database::Access::create}.run("CREATE TABLE a(b)");
    return file;
}

TEST(LockWait, LastsAsLongAsTheHolderWorks) {
    const auto file = file_of_a_table();
    const Holder holder{file, Journal::rollback, [] { work_for(4s); }};
    Database database{file, Database::Access::write};
    std::string told;
    database.set_lock_wait({.tell = [&](const std::string& words) { told += words; },
                            .stop = {},
                            .tell_after = 1ms,
                            .idle_limit = 2s}); // no pause of a busy machine is as long
    Transaction turn{database, Transaction::Kind::write};
    database.run("INSERT INTO a VALUES (1)");
    turn.commit();
    EXPECT_EQ(database.number("SELECT count(*) FROM a"), 1);
    EXPECT_THAT(told,
                AllOf(HasSubstr("waiting for '"),
                      HasSubstr("(process " + std::to_string(holder.process()) +
                                "), which is using the database; press Ctrl-C to stop waiting")));
}

TEST(LockWait, EndsWithWordsWhereTheHolderStandsStill) {
    const auto file = file_of_a_table();
    const Holder holder{file, Journal::rollback, stand_still};
    Database database{file, Database::Access::write};
    database.set_lock_wait({.tell = {}, .stop = {}, .tell_after = 1h, .idle_limit = 1s});
    EXPECT_THAT(refusal_of([&] {
                    Transaction{database, Transaction::Kind::write};
                }),
                AllOf(HasSubstr("a.db: is locked by '"),
                      HasSubstr("(process " + std::to_string(holder.process()) +
                                "), which has made no progress for 1 s; nothing more was "
                                "written, end that program and run this command again")));
}

TEST(LockWait, EndsWhenAStopIsAskedFor) {
    const auto file = file_of_a_table();
    const Holder holder{file, Journal::rollback, stand_still};
    Database database{file, Database::Access::write};
    std::stop_source source;
    database.set_lock_wait({.tell = [&](const std::string&) { source.request_stop(); },
                            .stop = source.get_token(),
                            .tell_after = 1ms,
                            .idle_limit = 1h});
    EXPECT_THAT(refusal_of([&] {
                    Transaction{database, Transaction::Kind::write};
                }),
                AllOf(HasSubstr("a.db: interrupted while waiting for '"),
                      HasSubstr("(process " + std::to_string(holder.process()) +
                                "); nothing more was written")));
}

TEST(LockWait, KnowsWhoHoldsTheLockWithAndWithoutALog) {
    const auto file = file_of_a_table();
    for (const auto journal : {Journal::rollback, Journal::log}) {
        EXPECT_FALSE(holder_of_lock(file));
        const Holder holder{file, journal, stand_still};
        const auto found = holder_of_lock(file);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->process, holder.process());
        EXPECT_TRUE(found->is_ours);
    }
}

TEST(LockWait, IsNotForReaders) {
    const auto file = test_folder() / "a.gpkg";
    fleet_store(file, trips_before);
    const auto digest = digest_of(file);
    const Holder holder{file, Journal::log, stand_still};
    EXPECT_EQ(digest_of(file), digest);
}

} // namespace
} // namespace macadam::testing
