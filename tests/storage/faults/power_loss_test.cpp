// What is on the disk when the power goes while trips come in: whatever was not synced is lost,
// kept in part, or torn. `./run test --all` looks at a thousand such disks.

#include "faulty_disk.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/road_store.hpp"
#include "store_import.hpp"
#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using testing::damage_of;
using testing::FaultyDisk;
using testing::import_into;
using testing::Loss;
using testing::test_folder;
using testing::tries;

constexpr std::array losses{Loss::all, Loss::some, Loss::torn};
constexpr int trips = 8;

/// A recorded import, and after how many operations each trip was acknowledged.
struct Recording {
    testing::DiskLog log;
    std::vector<std::size_t> acknowledged;
};

Recording recorded_import(const fs::path& file) {
    Recording recording;
    FaultyDisk disk;
    {
        auto store = RoadStore::open(file);
        import_into(store, trips, [&](int) {
            recording.acknowledged.push_back(disk.log().operations.size());
        });
    }
    recording.log = disk.log();
    return recording;
}

fs::path empty_folder(const fs::path& folder) {
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
}

TEST(PowerLoss, LosesNoTripThatWasAcknowledgedAndSpoilsNoStore) {
    const auto folder = test_folder();
    const auto file = folder / "a.gpkg";
    testing::new_store(file);
    const auto whole = testing::undisturbed_digest(file, trips);
    const auto recording = recorded_import(file);
    ASSERT_EQ(recording.acknowledged.size(), static_cast<std::size_t>(trips));

    std::mt19937 random{20261122};
    for (std::size_t image = 0; image < tries(36, 1000); ++image) {
        const auto when = random() % (recording.log.operations.size() + 1);
        const auto loss = losses[image % losses.size()];
        SCOPED_TRACE(::testing::Message() << "image " << image << ", after operation " << when);
        const auto left = empty_folder(folder / "left") / "a.gpkg";
        write_after_power_loss(
            recording.log, when, loss, static_cast<std::uint32_t>(image), left.parent_path());
        fs::copy_file(key_file_of(file), key_file_of(left)); // was on the disk before the store was

        const FaultyDisk sound;
        ASSERT_EQ(damage_of(left), "ok");
        {
            const auto store = StoreReader::open(left);
            for (int trip = 0; trip < trips; ++trip) {
                const auto at = recording.acknowledged[static_cast<std::size_t>(trip)];
                ASSERT_TRUE(at > when || store.contains_trip(testing::trip_record(trip).sha256));
            }
        }
        import_into(left, trips);
        ASSERT_EQ(StoreReader::open(left).digest(), whole);
    }
}

// ------------------------------------------------------------------ the same for any SQLite file

/// Rows that are lost at the worst, of `rows` that were committed one by one.
int max_lost(const fs::path& file, const std::string& settings, std::size_t images) {
    constexpr int rows = 20;
    Database{file, Database::Access::create}.run("CREATE TABLE a(b)");
    std::vector<std::size_t> committed;
    testing::DiskLog log;
    {
        FaultyDisk disk;
        Database database{file, Database::Access::write};
        database.run(settings);
        for (int row = 0; row < rows; ++row) {
            database.run("INSERT INTO a VALUES (zeroblob(3000))");
            committed.push_back(disk.log().operations.size());
        }
        database.close();
        log = disk.log();
    }
    int most = 0;
    std::mt19937 random{7};
    for (std::size_t image = 0; image < images; ++image) {
        const auto when = random() % (log.operations.size() + 1);
        const auto left = empty_folder(file.parent_path() / "left") / "a.db";
        write_after_power_loss(log,
                               when,
                               losses[image % losses.size()],
                               static_cast<std::uint32_t>(image),
                               left.parent_path());
        const FaultyDisk sound;
        Database database{left, Database::Access::write};
        const auto safe = std::ranges::upper_bound(committed, when) - committed.begin();
        most = std::max(most, static_cast<int>(safe - database.number("SELECT count(*) FROM a")));
    }
    return most;
}

TEST(PowerLoss, TakesNoCommitBackWithoutALogEither) {
    EXPECT_EQ(max_lost(test_folder() / "a.db", "", tries(60, 1000)), 0);
}

TEST(PowerLoss, TakesNoCommitBackWithALog) {
    EXPECT_EQ(max_lost(test_folder() / "a.db", "PRAGMA journal_mode = WAL", tries(60, 1000)), 0);
}

// The disk of these tests loses what was not synced: fewer syncs than ours are not enough.
TEST(PowerLoss, TakesCommitsBackThatWereNotSynced) {
    EXPECT_GT(max_lost(test_folder() / "a.db",
                       "PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL",
                       60),
              0);
}

TEST(PowerLoss, TakesACommitBackWhoseFolderWasNotSynced) {
    EXPECT_EQ(max_lost(test_folder() / "a.db", "PRAGMA synchronous = FULL", 60), 1);
}

} // namespace
} // namespace macadam
