// Commands that are asked to end while they wait or work, databases that go away below them, and
// what they leave.

#include "storage/networks/network_file.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/road_store.hpp"
#include "support/program/places.hpp"
#include "support/program/program.hpp"
#include "support/roads/store_world.hpp"
#include "support/roads/town.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <future>
#include <optional>
#include <set>
#include <thread>

#include <sys/stat.h>
#include <unistd.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using Clock = std::chrono::steady_clock;

// In an ordinary build it is 2 s (app/cli/interrupt_handler.hpp); sanitizers and a busy machine are
// slower.
constexpr auto longest_end = 60s;

std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator{folder}) {
        names.insert(fs::relative(entry.path(), folder).string());
    }
    return names;
}

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

/// Keeps everybody else out of a database.
class Lock {
public:
    explicit Lock(const fs::path& store) : database_{store, Database::Access::write} {
        database_.run("BEGIN EXCLUSIVE");
    }
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;
    ~Lock() { database_.run("ROLLBACK"); }

private:
    Database database_;
};

fs::path driven_store(const fs::path& folder) {
    const auto file = folder / "roads.gpkg";
    auto store = new_store(file);
    import_trips(store, 3);
    return file;
}

struct CommandCase {
    std::string name;
    std::vector<std::string> words; ///< STORE and OUT stand for files
};

void PrintTo(const CommandCase& command, std::ostream* out) {
    *out << command.name;
}

std::vector<CommandCase> commands() {
    return {{"query", {"query", "STORE", "--worst", "3"}},
            {"info", {"info", "STORE"}},
            {"export", {"export", "STORE", "-o", "OUT/a.geojson"}},
            {"export_gpkg", {"export", "STORE", "-o", "OUT/a.gpkg"}},
            {"export_shp", {"export", "STORE", "-o", "OUT/a.shp"}},
            {"tiles", {"export", "STORE", "-o", "OUT/a.mbtiles"}},
            {"picture_tiles",
             {"export", "STORE", "-o", "OUT/tiles/", "--tiles", "picture", "--zoom", "12"}},
            {"render", {"render", "STORE", "-o", "OUT/a.png", "--size", "400x300"}},
            {"report", {"report", "STORE", "-o", "OUT/a.html"}},
            {"dry_calibrate", {"calibrate", "STORE", "--dry-run"}},
            {"import", {"import", "STORE", "STORE"}},
            {"calibrate", {"calibrate", "STORE"}},
            {"forget", {"forget", "STORE", "--trip", "trip-1"}},
            {"valid_from", {"valid-from", "STORE", "--since", "2026-01-01", "--way", "1"}}};
}

std::vector<std::string>
words_of(const CommandCase& command, const fs::path& store, const fs::path& out) {
    auto words = command.words;
    for (auto& word : words) {
        if (word == "STORE") {
            word = store.string();
        } else if (word.starts_with("OUT/")) {
            word = out.string() + word.substr(3);
        }
    }
    return words;
}

struct Place {
    fs::path folder, store, out;
};

Place new_place() {
    const auto folder = fresh_folder();
    fs::create_directory(folder / "out");
    return {folder, driven_store(folder), folder / "out"};
}

class CommandBesideALock : public ::testing::TestWithParam<CommandCase> {};

TEST_P(CommandBesideALock, SaysForWhomItWaitsAndEndsWhenItIsInterrupted) {
    const auto place = new_place();
    const auto before = names_in(place.folder);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const Lock lock{place.store};
        Clock::time_point signalled;
        const auto run = run_macadam_signalled(
            words_of(GetParam(), place.store, place.out),
            [&] {
                signalled = Clock::now();
                return was_said("roads.gpkg: waiting for '");
            },
            signal);
        EXPECT_LT(Clock::now() - signalled, longest_end);
        EXPECT_EQ(run.exit_status, 1);
        EXPECT_THAT(run.err, HasSubstr("waiting for '"));
        EXPECT_THAT(run.err, HasSubstr(" interrupted"));
    }
    EXPECT_EQ(names_in(place.folder), before);
}

INSTANTIATE_TEST_SUITE_P(Commands,
                         CommandBesideALock,
                         ::testing::ValuesIn(commands()),
                         [](const auto& test) { return test.param.name; });

class CommandWhoseDatabaseGoes : public ::testing::TestWithParam<CommandCase> {};

/// The command has opened the file and waits; then its name leads to nothing, or to another file.
Run run_while_it_goes(const std::vector<std::string>& words, const Place& place, bool is_replaced) {
    std::optional<Lock> lock{std::in_place, place.store};
    auto run = std::async(std::launch::async, [&] { return run_macadam(words); });
    while (!was_said("waiting for '") && run.wait_for(20ms) != std::future_status::ready) {
    }
    const auto aside = place.folder / "aside.gpkg";
    fs::rename(place.store, aside);
    if (is_replaced) {
        fs::copy_file(aside, place.store);
    }
    lock.reset();
    return run.get();
}

TEST_P(CommandWhoseDatabaseGoes, FailsWithWordsAndLeavesNoOutput) {
    for (const bool is_replaced : {false, true}) {
        const auto place = new_place();
        const auto run =
            run_while_it_goes(words_of(GetParam(), place.store, place.out), place, is_replaced);
        EXPECT_EQ(run.exit_status, 1) << run.err;
        EXPECT_THAT(run.err,
                    AnyOf(HasSubstr("roads.gpkg: was removed or replaced while this command "
                                    "was using it; run the command again"),
                          HasSubstr("roads.gpkg: no such file"),
                          HasSubstr("roads.gpkg: No such file"),
                          HasSubstr("roads.gpkg: cannot be opened")));
        EXPECT_TRUE(fs::is_empty(place.out));
    }
}

/// Those that end well where nothing happens to the database.
std::vector<CommandCase> commands_that_succeed() {
    auto all = commands();
    std::erase_if(all, [](const CommandCase& command) {
        return command.name == "import" || command.name.ends_with("calibrate");
    });
    return all;
}

INSTANTIATE_TEST_SUITE_P(Commands,
                         CommandWhoseDatabaseGoes,
                         ::testing::ValuesIn(commands_that_succeed()),
                         [](const auto& test) { return test.param.name; });

// ------------------------------------------------------------------------- in the middle of work

fs::path town_store(const fs::path& folder) {
    auto file = folder / "town.gpkg";
    RoadStore::create(file, made_up_town(40), {});
    return file;
}

bool any_begun(const fs::path& folder) {
    std::error_code gone; // a folder, while it is looked into
    for (fs::recursive_directory_iterator each{folder, gone}; each != end(each);
         each.increment(gone)) {
        if (each->path().filename().string().find(".part-") != std::string::npos) {
            return true;
        }
    }
    return false;
}

/// Exports and sends the signal once the file is begun; anew where the export ended before it came.
Run cut_off_export(const fs::path& store, const fs::path& file, int signal) {
    for (;;) {
        auto run = run_macadam_signalled(
            {"export", store.string(), "--all", "-o", file.string()},
            [&] { return any_begun(file.parent_path()); },
            signal);
        if (run.exit_status != 0) {
            return run;
        }
        fs::remove_all(file.parent_path());
        fs::create_directory(file.parent_path());
    }
}

TEST(NetworkFileInUse, CutShortByOthersEndsTheCommandWithWords) {
    const auto folder = fresh_folder();
    const auto network = folder / "network";
    write_network_file(small_country(), std::string(64, '7'), network);
    const auto trip = folder / "a.trip.csv";
    ASSERT_EQ(::mkfifo(trip.c_str(), 0600), 0);
    auto run = std::async(std::launch::async, [&] {
        return run_macadam({"match", trip.string(), "--network", network.string()});
    });
    {
        std::ofstream rows{trip}; // waits for the program, which has opened the network then
        fs::resize_file(network, 0);
        rows << read_file(source_folder() + "/tests/fuzz/seeds/trip_trace/receiver.csv");
    }
    const auto ended = run.get();
    EXPECT_EQ(ended.exit_status, 1);
    EXPECT_EQ(ended.err,
              "macadam match: a file that it was reading was cut short or cannot be read any "
              "more; run the command again\n");
}

TEST(InterruptedOutput, LeavesNothingOfAnyKind) {
    const auto folder = fresh_folder();
    const auto store = town_store(folder);
    const auto out = folder / "out";
    fs::create_directory(out);
    for (const auto* name : {"a.gpkg", "a.shp", "a.fgb"}) {
        for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
            const auto run = cut_off_export(store, out / name, signal);
            EXPECT_EQ(run.exit_status, 1) << name;
            EXPECT_THAT(run.err, AnyOf(HasSubstr(" interrupted"), HasSubstr(" stopped before")));
            EXPECT_TRUE(fs::is_empty(out)) << name;
        }
    }
}

TEST(KilledOutput, IsNamedByTheNextRun) {
    const auto folder = fresh_folder();
    const auto store = town_store(folder);
    const auto out = folder / "out";
    fs::create_directory(out);
    ASSERT_EQ(cut_off_export(store, out / "a.gpkg", SIGKILL).exit_status, 128 + SIGKILL);
    const auto next =
        run_macadam({"export", store.string(), "--all", "-o", (out / "a.gpkg").string()});
    EXPECT_EQ(next.exit_status, 0);
    EXPECT_THAT(next.err,
                ::testing::ContainsRegex("out/a.gpkg.part-[0-9a-z]+: left behind by a run that "
                                         "was killed \\([0-9.]+ MB\\); it is not needed and "
                                         "can be deleted"));
}

TEST(Output, OfTwoProcessesOfOneNumberIsWholeAndOfOneOfThem) {
    const auto folder = fresh_folder();
    const auto store = driven_store(folder);
    const bool may_make_namespaces = std::system("unshare -pf true 2> /dev/null") == 0;
    const std::string own_numbers = may_make_namespaces ? "unshare -pf --mount-proc " : "";
    const auto alone = folder / "alone.geojson";
    ASSERT_EQ(run_macadam({"export", store.string(), "--all", "-o", alone.string()}).exit_status,
              0);
    for (int i = 0; i < 3; ++i) {
        const auto line =
            fmt::format("cd {0} && for n in 1 2; do {1} {2} export roads.gpkg --all -o "
                        "shared.geojson 2> err.$n & done; wait",
                        folder.string(),
                        own_numbers,
                        program_file());
        ASSERT_EQ(std::system(line.c_str()), 0);
        EXPECT_EQ(read_file(folder / "shared.geojson"), read_file(alone));
        fs::remove(folder / "shared.geojson");
    }
    EXPECT_FALSE(any_begun(folder));
}

TEST(Output, AsAGeoPackageIsTheSameBytesEachTime) {
    const auto folder = fresh_folder();
    const auto store = driven_store(folder);
    for (const auto* name : {"a.gpkg", "b.gpkg"}) {
        ASSERT_EQ(run_macadam({"export", store.string(), "--all", "-o", (folder / name).string()})
                      .exit_status,
                  0);
        std::this_thread::sleep_for(5ms); // times are written to the millisecond
    }
    EXPECT_TRUE(read_file(folder / "a.gpkg") == read_file(folder / "b.gpkg"));
}

} // namespace
} // namespace macadam::testing
