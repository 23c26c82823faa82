// `macadam import` where things go wrong: killed at any moment, on a failing disk, four of them at
// once beside readers. `./run test --all` does each hundreds of times.

#include "storage/sqlite/sqlite.hpp"
#include "storage/store/road_store.hpp"
#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <future>
#include <ostream>
#include <random>
#include <sstream>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using Clock = std::chrono::steady_clock;
using Finished = Run; // a test has another Run

bool tries_all() {
    return std::getenv("MACADAM_TEST_ALL") != nullptr;
}

/// With its key.
void copy_store(const fs::path& from, const fs::path& to) {
    for (const auto* const suffix : {"", ".key"}) {
        fs::copy_file(
            from.string() + suffix, to.string() + suffix, fs::copy_options::overwrite_existing);
    }
}

/// Short trips of one road, an empty store of it, and what they come to undisturbed.
struct World {
    std::vector<std::string> trips;
    fs::path empty;
    fs::path store;
    std::string digest;
    Clock::duration import_time;
};

std::string text_of_trip(int number) {
    const Drive drive{.length_m = 300,
                      .speed_mps = 15.0 + number % 7,
                      .trip_id = fmt::format("trip-{}", number),
                      .vehicle_id = fmt::format("car-{}", number % 3)};
    return text_of(drive_over(patched_road([](double) { return false; }, 1),
                              drive,
                              *built_in_vehicle("golden-car")),
                   drive);
}

std::vector<std::string> import_words(const fs::path& store,
                                      const std::vector<std::string>& trips) {
    std::vector<std::string> words{
        "import", store.string(), "--method", "kf", "--vehicle", "golden-car", "--json"};
    words.insert(words.end(), trips.begin(), trips.end());
    return words;
}

std::string digest_of(const fs::path& store) {
    return StoreReader::open(store).digest();
}

World world(int trips) {
    const auto folder = fresh_folder();
    World made{.trips = {},
               .empty = folder / "empty.gpkg",
               .store = folder / "roads.gpkg",
               .digest = "",
               .import_time = {}};
    for (int number = 0; number < trips; ++number) {
        const auto file = folder / fmt::format("{}.trip.csv", number);
        write_file(file, text_of_trip(number));
        made.trips.push_back(file.string());
    }
    EXPECT_EQ(run_macadam({"init", made.empty.string(), "--trace", made.trips[0]}).exit_status, 0);
    const auto whole = folder / "whole.gpkg";
    copy_store(made.empty, whole);
    const auto begin = Clock::now();
    EXPECT_EQ(run_macadam(import_words(whole, made.trips)).exit_status, 0);
    made.import_time = Clock::now() - begin;
    made.digest = digest_of(whole);
    return made;
}

void start_anew(const World& made) {
    copy_store(made.empty, made.store);
}

/// Hashes of the trips that an import reported to be in the store; a line that was cut off is none.
std::vector<std::string> reported(const std::string& out) {
    std::vector<std::string> hashes;
    std::istringstream lines{out.substr(0, out.rfind('\n') + 1)};
    for (std::string line; std::getline(lines, line);) {
        const auto trip = nlohmann::json::parse(line);
        if (trip["result"] != "rejected") {
            hashes.push_back(trip["sha256"]);
        }
    }
    return hashes;
}

void expect_sound_with(const std::vector<std::string>& trips, const fs::path& store) {
    Database database{store, Database::Access::write};
    auto check = database.prepare("PRAGMA integrity_check");
    check.step();
    EXPECT_EQ(check.text(0), "ok");
    auto find = database.prepare("SELECT 1 FROM trip WHERE sha256 = ?");
    for (const auto& trip : trips) {
        EXPECT_TRUE(find.bind(trip).step()) << trip;
    }
}

void expect_completed(const World& made) {
    const auto rest = run_macadam(import_words(made.store, made.trips));
    EXPECT_EQ(rest.exit_status, 0) << rest.err;
    EXPECT_EQ(digest_of(made.store), made.digest);
}

TEST(KilledImport, LosesNoTripThatItReportedAndTakesNoneTwice) {
    const auto made = world(tries_all() ? 30 : 4);
    const int wanted = tries_all() ? 500 : 5;
    std::mt19937 random{20261122};
    int kills = 0;
    std::size_t kept = 0;
    start_anew(made);
    while (kills < wanted) {
        SCOPED_TRACE(::testing::Message() << "kill " << kills);
        const auto until = Clock::now() + made.import_time * (random() % 1000) / 1000;
        const auto run = run_macadam_signalled(
            import_words(made.store, made.trips), [&] { return Clock::now() > until; }, SIGKILL);
        const auto trips = reported(run.out);
        kept += trips.size();
        expect_sound_with(trips, made.store);
        if (run.exit_status == 0 || trips.size() == made.trips.size()) {
            expect_completed(made);
            start_anew(made);
        }
        if (run.exit_status != 0) {
            ASSERT_EQ(run.exit_status, 128 + SIGKILL) << run.err;
            ++kills;
        }
    }
    expect_completed(made);
    std::cout << kills << " kills, " << kept << " trips reported before them\n";
}

// ------------------------------------------------------------------------------- a failing disk

/// Runs the program with the faulty disk of the store's own tests below its SQLite.
Run import_with(const std::string& fault, const World& made) {
    ::setenv("LD_PRELOAD", MACADAM_FAULTY_DISK, 1);
    ::setenv("MACADAM_TEST_FAULT", fault.c_str(), 1);
    ::setenv("ASAN_OPTIONS", "verify_asan_link_order=0:detect_leaks=0", 1);
    auto run = run_macadam(import_words(made.store, made.trips));
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

void PrintTo(const DiskCase& disk, std::ostream* out) {
    *out << disk.fault;
}

class FailingDisk : public ::testing::TestWithParam<DiskCase> {};

TEST_P(FailingDisk, IsNamedAndTheNextImportCompletes) {
    const auto made = world(tries_all() ? 12 : 2);
    const int step = tries_all() ? 1 : GetParam().step;
    const int enough_without_a_failure = tries_all() ? 8 : 1;
    int failed = 0;
    int whole = 0;
    for (int number = 1; number <= 500 && whole < enough_without_a_failure; number += step) {
        SCOPED_TRACE(::testing::Message() << GetParam().fault << " at access " << number);
        start_anew(made);
        const auto run = import_with(fmt::format("{} {}", GetParam().fault, number), made);
        expect_sound_with(reported(run.out), made.store);
        if (run.exit_status == 0) {
            EXPECT_EQ(digest_of(made.store), made.digest);
            ++whole; // it may have no more accesses
        } else {
            ++failed;
            whole = 0;
            EXPECT_EQ(run.exit_status, 1);
            EXPECT_THAT(run.err,
                        ContainsRegex("macadam import: .*roads\\.gpkg: .*" + GetParam().cause));
            expect_completed(made);
        }
    }
    EXPECT_GT(failed, 0);
    std::cout << failed << " imports failed\n";
}

INSTANTIATE_TEST_SUITE_P(
    Import,
    FailingDisk,
    ::testing::Values(
        DiskCase{
            "full", "(no space left on the disk|No space left on device|cannot be opened)", 23},
        DiskCase{"broken", "(Input/output error|cannot be opened|disk I/O error)", 37},
        DiskCase{"no_sync", "(Input/output error|disk I/O error)", 4}),
    [](const auto& test) { return test.param.fault; });

TEST(LimitedFileSize, IsNamedAndTheNextImportCompletes) {
    const auto made = world(2);
    const auto least = fs::file_size(made.empty);
    int failed = 0;
    for (std::size_t room = 4096; room < least; room += tries_all() ? 4096 : 100'000) {
        start_anew(made);
        const auto run = run_macadam(import_words(made.store, made.trips), room);
        expect_sound_with(reported(run.out), made.store);
        if (run.exit_status != 0) {
            ++failed;
            EXPECT_THAT(run.err,
                        ContainsRegex("roads\\.gpkg.*: .*(File too large|disk I/O error)"));
            expect_completed(made);
        }
    }
    EXPECT_GT(failed, 0);
}

// ------------------------------------------------------------------------------- many at a time

TEST(FourImporters, AndReadersOfOneStoreNeverMeetALock) {
    const auto made = world(tries_all() ? 48 : 4);
    start_anew(made);
    const auto share = [&](std::size_t importer) { // each trip is imported by two of them
        std::vector<std::string> trips;
        for (std::size_t i = 0; i < made.trips.size(); ++i) {
            const auto trip = importer % 2 == 0 ? i : made.trips.size() - 1 - i;
            if (trip % 2 == importer / 2) {
                trips.push_back(made.trips[trip]);
            }
        }
        return trips;
    };
    std::vector<std::future<Finished>> importers;
    for (std::size_t importer = 0; importer < 4; ++importer) {
        importers.push_back(std::async(std::launch::async, [&made, trips = share(importer)] {
            return run_macadam(import_words(made.store, trips));
        }));
    }
    std::atomic<bool> importing = true;
    const auto read_on = [&](const std::vector<std::string>& words) {
        do {
            const auto run = run_macadam(words);
            EXPECT_EQ(run.exit_status, 0) << run.err;
            EXPECT_THAT(run.err, Not(HasSubstr("locked")));
        } while (importing);
    };
    const auto store = made.store.string();
    auto info = std::async(std::launch::async, [&] { read_on({"info", store, "--digest"}); });
    auto query = std::async(std::launch::async, [&] {
        read_on({"query", store, "--worst", "2", "--segments"});
    });
    std::size_t trips = 0;
    for (auto& importer : importers) {
        const auto run = importer.get();
        EXPECT_EQ(run.exit_status, 0) << run.err;
        EXPECT_THAT(run.err, Not(HasSubstr("locked")));
        trips += reported(run.out).size();
    }
    importing = false;
    info.get();
    query.get();
    EXPECT_EQ(trips, 2 * made.trips.size());
    EXPECT_EQ(digest_of(made.store), made.digest);
    expect_sound_with({}, made.store);
    EXPECT_FALSE(fs::exists(store + "-wal"));
}

} // namespace
} // namespace macadam::testing
