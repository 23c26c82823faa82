// `macadam calibrate`, `reprocess`, `forget`, `valid-from`, `import --reference` and `init
// --update` where things go wrong: killed at any moment, on a failing disk, while another program
// holds the store. `./run test --all` does each many times.

#include "storage/networks/network_file.hpp"
#include "storage/networks/osm_writer.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "support/program/places.hpp"
#include "support/program/program.hpp"
#include "support/roads/edited_network.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <future>
#include <optional>
#include <ostream>
#include <random>
#include <thread>

#include <unistd.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using Clock = std::chrono::steady_clock;
using Words = std::vector<std::string>;

bool tries_all() {
    return std::getenv("MACADAM_TEST_ALL") != nullptr;
}

/// A store of twelve trips of three cars, and what may be done to it.
struct World {
    fs::path folder;
    fs::path base;
    fs::path store;
};

const std::string log_of_gyor = source_folder() + "/sample_data/gyor/gyor_q3_00.trip.csv";

World country() {
    World made{fresh_folder(), {}, {}};
    made.base = made.folder / "base.gpkg";
    made.store = made.folder / "roads.gpkg";
    auto store = new_store(made.base);
    import_trips(store, 12);
    cache_network(store, small_country());
    return made;
}

World gyor() {
    World made{fresh_folder(), {}, {}};
    made.base = made.folder / "base.gpkg";
    made.store = made.folder / "roads.gpkg";
    const auto base = made.base.string();
    EXPECT_EQ(run_macadam({"init", base, "--trace", log_of_gyor}).exit_status, 0);
    EXPECT_EQ(run_macadam({"import", base, log_of_gyor, "--method", "kf"}).exit_status, 0);
    return made;
}

std::string survey(const World& made) {
    const auto file = made.folder / "laser.csv";
    std::string rows = "way_id,from_m,to_m,direction,mri\n";
    for (int i = 0; i < 10; ++i) {
        rows += fmt::format("1,{},{},forward,{}\n", 20 * i, 20 * (i + 1), 1.5 + 0.1 * i);
    }
    write_file(file, rows);
    return file.string();
}

std::string newer_map(const World& made) {
    auto network = edited(copies_of_ways(small_country()));
    for (auto& [way, steps] : network.ways) {
        way.highway = "residential"; // what a car may use
        way.turns.clear();
    }
    renumber(network, 1, 100);
    erase(network, 3);
    const auto file = made.folder / "newer.osm.pbf";
    write_osm(ways_of(network), file);
    return file.string();
}

struct CommandCase {
    std::string name;
    std::function<World()> world;
    std::function<Words(const World&)> words; ///< without the store
    int commits = 1;
};

void PrintTo(const CommandCase& command, std::ostream* out) {
    *out << command.name;
}

std::vector<CommandCase> commands() {
    return {{"calibrate", country, [](const World&) { return Words{"calibrate"}; }},
            {"forget",
             country,
             [](const World&) {
                 return Words{"forget", "--trip", "trip-4"};
             }},
            {"valid_from",
             country,
             [](const World&) {
                 return Words{"valid-from", "--since", "2026-05-01", "--way", "1"};
             }},
            {"reprocess",
             gyor,
             [](const World&) {
                 return Words{"reprocess", log_of_gyor, "--method", "kf", "--rate", "50"};
             }},
            {"reference", // it comes in, then it is fused
             country,
             [](const World& made) {
                 return Words{"import", "--reference", survey(made), "--date", "2026-05-01"};
             },
             2},
            {"update", country, [](const World& made) {
                 return Words{"init", "--update", newer_map(made)};
             }}};
}

Words with_store(Words words, const World& made) {
    words.insert(words.begin() + 1, made.store.string());
    return words;
}

void start_anew(const World& made) {
    for (const auto* const suffix : {"-wal", "-shm", "-journal"}) {
        fs::remove(made.store.string() + suffix);
    }
    fs::copy_file(made.base, made.store, fs::copy_options::overwrite_existing);
}

std::string digest_of(const fs::path& store) {
    return StoreReader::open(store).digest();
}

/// A command with what it makes of the store when nothing is in its way.
struct Deed {
    World world;
    Words words;
    int commits;
    std::string before;
    std::string after;
    Clock::duration time;
};

Deed deed_of(const CommandCase& command) {
    Deed deed{command.world(), {}, command.commits, "", "", {}};
    deed.words = with_store(command.words(deed.world), deed.world);
    start_anew(deed.world);
    deed.before = digest_of(deed.world.store);
    const auto begin = Clock::now();
    const auto run = run_macadam(deed.words);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    deed.time = Clock::now() - begin;
    deed.after = digest_of(deed.world.store);
    EXPECT_NE(deed.before, deed.after);
    return deed;
}

/// The store is as it was or as it is to be; then it is made so.
void expect_whole_and_completed(const Deed& deed) {
    {
        Database database{deed.world.store, Database::Access::write};
        auto check = database.prepare("PRAGMA integrity_check");
        check.step();
        EXPECT_EQ(check.text(0), "ok");
    }
    const auto digest = digest_of(deed.world.store);
    if (deed.commits == 1) {
        EXPECT_TRUE(digest == deed.before || digest == deed.after);
    }
    if (digest != deed.after) {
        const auto again = run_macadam(deed.words);
        EXPECT_EQ(again.exit_status, 0) << again.err;
        EXPECT_EQ(digest_of(deed.world.store), deed.after);
    }
}

// ------------------------------------------------------------------------------------------ kills

class KilledUpkeep : public ::testing::TestWithParam<CommandCase> {};

TEST_P(KilledUpkeep, LeavesTheStoreAsItWasOrAsItIsToBe) {
    const auto deed = deed_of(GetParam());
    std::mt19937 random{20261122};
    for (int kill = 0; kill < (tries_all() ? 100 : 3); ++kill) {
        SCOPED_TRACE(::testing::Message() << "kill " << kill);
        start_anew(deed.world);
        const auto until = Clock::now() + deed.time * (random() % 1000) / 1000;
        const auto run = run_macadam_signalled(
            deed.words, [&] { return Clock::now() > until; }, SIGKILL);
        EXPECT_THAT(run.exit_status, ::testing::AnyOf(0, 128 + SIGKILL)) << run.err;
        expect_whole_and_completed(deed);
    }
}

INSTANTIATE_TEST_SUITE_P(Command,
                         KilledUpkeep,
                         ::testing::ValuesIn(commands()),
                         [](const auto& test) { return test.param.name; });

// ----------------------------------------------------------------------------------- failing disk

/// With the faulty disk of the store's own tests below the program's SQLite.
Run run_with(const std::string& fault, const Words& words) {
    ::setenv("LD_PRELOAD", MACADAM_FAULTY_DISK, 1);
    ::setenv("MACADAM_TEST_FAULT", fault.c_str(), 1);
    ::setenv("ASAN_OPTIONS", "verify_asan_link_order=0:detect_leaks=0", 1);
    auto run = run_macadam(words);
    ::unsetenv("LD_PRELOAD");
    ::unsetenv("MACADAM_TEST_FAULT");
    ::unsetenv("ASAN_OPTIONS");
    return run;
}

struct DiskCase {
    std::string fault;
    std::string cause;
    int step; ///< of the ordinary tests
};

class UpkeepOnAFailingDisk : public ::testing::TestWithParam<CommandCase> {};

TEST_P(UpkeepOnAFailingDisk, NamesTheStoreAndTheCauseAndIsCompletedByTheNext) {
    const auto deed = deed_of(GetParam());
    const std::vector<DiskCase> disks{
        {"full", "(no space left on the disk|No space left on device|cannot be opened)", 41},
        {"broken", "(Input/output error|cannot be opened|disk I/O error)", 67},
        {"no_sync", "(Input/output error|disk I/O error)", 3}};
    for (const auto& [fault, cause, step] : disks) {
        int failed = 0;
        for (int number = 1, whole = 0; number <= 500 && whole < 2;
             number += tries_all() ? 1 : step) {
            SCOPED_TRACE(::testing::Message() << fault << " at access " << number);
            start_anew(deed.world);
            const auto run = run_with(fmt::format("{} {}", fault, number), deed.words);
            if (run.exit_status == 0) {
                EXPECT_EQ(digest_of(deed.world.store), deed.after);
                ++whole; // it may have no more accesses
            } else {
                ++failed;
                whole = 0;
                EXPECT_EQ(run.exit_status, 1);
                EXPECT_THAT(
                    run.err,
                    ContainsRegex("macadam " + deed.words[0] + ": .*roads\\.gpkg.*: .*" + cause));
                expect_whole_and_completed(deed);
            }
        }
        EXPECT_GT(failed, 0) << fault;
    }
}

INSTANTIATE_TEST_SUITE_P(Command,
                         UpkeepOnAFailingDisk,
                         ::testing::ValuesIn(commands()),
                         [](const auto& test) { return test.param.name; });

// --------------------------------------------------------------------------------- another's lock

/// Keeps others from writing while it lives.
class Lock {
public:
    explicit Lock(const fs::path& store) : database_{store, Database::Access::write} {
        database_.enable_wal();
        held_.emplace(database_, Transaction::Kind::write);
    }

private:
    Database database_;
    std::optional<Transaction> held_;
};

/// Whether a program that this one started has said so on standard error.
bool was_said(const std::string& words) {
    const auto ours = fmt::format("macadam_err_{}_", ::getpid());
    for (const auto& entry : fs::directory_iterator{::testing::TempDir()}) {
        if (entry.path().filename().string().starts_with(ours) &&
            read_file(entry.path()).find(words) != std::string::npos) {
            return true;
        }
    }
    return false;
}

class UpkeepBesideALock : public ::testing::TestWithParam<CommandCase> {};

TEST_P(UpkeepBesideALock, SaysForWhomItWaitsAndGoesOn) {
    const auto deed = deed_of(GetParam());
    start_anew(deed.world);
    std::optional<Lock> lock{std::in_place, deed.world.store};
    auto run = std::async(std::launch::async, [&] { return run_macadam(deed.words); });
    while (!was_said("waiting for '") &&
           run.wait_for(std::chrono::milliseconds{50}) != std::future_status::ready) {
    }
    lock.reset();
    const auto ended = run.get();
    EXPECT_EQ(ended.exit_status, 0) << ended.err;
    EXPECT_THAT(ended.err,
                AllOf(HasSubstr("roads.gpkg: waiting for '"),
                      HasSubstr(fmt::format("(process {}), which is using the database; press "
                                            "Ctrl-C to stop waiting\n",
                                            ::getpid()))));
    EXPECT_EQ(digest_of(deed.world.store), deed.after);
}

TEST_P(UpkeepBesideALock, EndsTheWaitWhenItIsInterrupted) {
    const auto deed = deed_of(GetParam());
    start_anew(deed.world);
    std::optional<Lock> lock{std::in_place, deed.world.store};
    const auto run = run_macadam_signalled(
        deed.words, [] { return was_said("waiting for '"); }, SIGINT);
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("roads.gpkg: interrupted while waiting for '"));
    lock.reset();
    EXPECT_EQ(digest_of(deed.world.store), deed.before);
}

INSTANTIATE_TEST_SUITE_P(Command,
                         UpkeepBesideALock,
                         ::testing::ValuesIn(commands()),
                         [](const auto& test) { return test.param.name; });

} // namespace
} // namespace macadam::testing
