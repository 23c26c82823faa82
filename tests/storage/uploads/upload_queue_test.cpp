#include "storage/uploads/upload_queue.hpp"

#include "estimator/common/error.hpp"
#include "storage/uploads/upload_database.hpp"
#include "support/files/files.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <iterator>
#include <string>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

struct World {
    fs::path store = test_folder() / "roads.gpkg";
    fs::path spool = spool_of(store);
    Database uploads = opened(store);

    static Database opened(const fs::path& store) {
        make_uploads_folder(store);
        return open_uploads(store);
    }

    static Upload upload(char digit, const std::string& owner = "anna") {
        return {
            .sha256 = std::string(64, digit), .owner = owner, .suffix = ".trip.csv", .bytes = 3};
    }

    bool send(const Upload& upload) {
        AtomicFile file{upload.file_in(spool)};
        file.write("log");
        return enqueue(uploads, file, upload);
    }

    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator{spool}, fs::directory_iterator{}));
    }
};

TEST(UploadQueue, TakesEachLogOnceInTheOrderOfArrival) {
    World world;
    ASSERT_TRUE(world.send(World::upload('b')));
    ASSERT_TRUE(world.send(World::upload('a')));
    EXPECT_FALSE(world.send(World::upload('b')));
    const auto taken = take_uploads(world.uploads, world.spool, 10);
    ASSERT_EQ(taken.size(), 2U);
    EXPECT_EQ(taken[0].upload().sha256, std::string(64, 'b'));
    EXPECT_EQ(taken[1].upload().sha256, std::string(64, 'a'));
    EXPECT_TRUE(take_uploads(world.uploads, world.spool, 10).empty());
    auto others = open_uploads(world.store);
    EXPECT_TRUE(take_uploads(others, world.spool, 10).empty());
}

TEST(UploadQueue, GivesTheLogsOfADeadWorkerToAnotherOneByOne) {
    World world;
    world.send(World::upload('a'));
    world.send(World::upload('b'));
    { const auto dead = take_uploads(world.uploads, world.spool, 10); }
    const auto again = take_uploads(world.uploads, world.spool, 10);
    ASSERT_EQ(again.size(), 1U);
    EXPECT_EQ(again[0].upload().attempts, 2);
}

TEST(UploadQueue, TakesNewLogsBeforeThoseThatMayHaveEndedTheProgram) {
    World world;
    world.send(World::upload('a'));
    { const auto dead = take_uploads(world.uploads, world.spool, 10); }
    world.send(World::upload('b'));
    EXPECT_TRUE(take_uploads(world.uploads, world.spool, 10, -1).empty());
    const auto taken = take_uploads(world.uploads, world.spool, 10, 0);
    ASSERT_EQ(taken.size(), 1U);
    EXPECT_EQ(taken[0].upload().sha256, std::string(64, 'b'));
}

TEST(UploadQueue, WaitsForNoLogThatIsMissing) {
    World world;
    ASSERT_TRUE(world.send(World::upload('a')));
    fs::remove(World::upload('a').file_in(world.spool));
    EXPECT_TRUE(take_uploads(world.uploads, world.spool, 10).empty());
    EXPECT_EQ(count_waiting(world.uploads), 0U);
    EXPECT_EQ(find_upload(world.uploads, World::upload('a').sha256)->reason, "the log is missing");
    EXPECT_TRUE(world.send(World::upload('a')));
}

TEST(UploadQueue, IsNotReadFromAFolderThatAllCanWriteTo) {
    World world;
    fs::permissions(uploads_folder_of(world.store), fs::perms::all);
    EXPECT_THROW(open_uploads(world.store), InputError);
    fs::permissions(uploads_folder_of(world.store), fs::perms::owner_all);
    EXPECT_NO_THROW(open_uploads(world.store));
}

TEST(UploadQueue, ForgetsTheLogButNotTheFate) {
    World world;
    world.send(World::upload('a'));
    const auto taken = take_uploads(world.uploads, world.spool, 1);
    ASSERT_EQ(taken.size(), 1U);
    add_trip_of(world.uploads, taken[0].upload(), "trip", 12);
    finish_upload(world.uploads, world.spool, taken[0].upload(), UploadState::imported, "");
    EXPECT_EQ(world.files(), 0U);
    const auto found = find_upload(world.uploads, std::string(64, 'a'));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->state, UploadState::imported);
    EXPECT_EQ(found->passes, 12);
    EXPECT_FALSE(world.send(World::upload('a')));
}

TEST(UploadQueue, TriesARefusedLogAgain) {
    World world;
    world.send(World::upload('a'));
    const auto taken = take_uploads(world.uploads, world.spool, 1);
    finish_upload(world.uploads, world.spool, taken.at(0).upload(), UploadState::refused, "why");
    EXPECT_FALSE(world.send(World::upload('a', "somebody else")));
    EXPECT_TRUE(world.send(World::upload('a')));
    EXPECT_EQ(find_upload(world.uploads, std::string(64, 'a'))->state, UploadState::queued);
}

TEST(UploadQueue, KeepsTheFirstSenderOfATrip) {
    World world;
    world.send(World::upload('a'));
    world.send(World::upload('b', "ben"));
    add_trip_of(world.uploads, World::upload('a'), "trip", 12);
    add_trip_of(world.uploads, World::upload('b'), "trip", 12);
    EXPECT_TRUE(is_trip_of(world.uploads, World::upload('a'), "trip"));
    EXPECT_FALSE(is_trip_of(world.uploads, World::upload('b'), "trip"));
    EXPECT_TRUE(is_trip_of_any(world.uploads, "trip"));
}

TEST(UploadQueue, DeletesALogThatNobodyHasBegun) {
    World world;
    world.send(World::upload('a'));
    EXPECT_TRUE(delete_upload(world.uploads, world.spool, std::string(64, 'a')));
    EXPECT_EQ(world.files(), 0U);
    EXPECT_FALSE(find_upload(world.uploads, std::string(64, 'a')));
}

TEST(UploadQueue, LeavesTheDeletionOfTripsToAWorker) {
    World world;
    world.send(World::upload('a'));
    const auto taken = take_uploads(world.uploads, world.spool, 1);
    EXPECT_FALSE(delete_upload(world.uploads, world.spool, std::string(64, 'a')));
    EXPECT_FALSE(next_deletion(world.uploads)); // it is still worked on
    add_trip_of(world.uploads, taken.at(0).upload(), "trip", 12);
    finish_upload(world.uploads, world.spool, taken.at(0).upload(), UploadState::imported, "");
    const auto deletion = next_deletion(world.uploads);
    ASSERT_TRUE(deletion);
    EXPECT_EQ(deletion->trips, std::vector<std::string>{"trip"});
    finish_deletion(world.uploads, deletion->upload);
    EXPECT_FALSE(find_upload(world.uploads, std::string(64, 'a')));
    EXPECT_FALSE(is_trip_of_any(world.uploads, "trip"));
}

TEST(UploadQueue, SweepsFilesThatNobodyAcknowledged) {
    World world;
    world.send(World::upload('a'));
    written(world.spool, std::string(64, 'b') + ".trip.csv", "log");
    sweep_spool(world.uploads, world.spool);
    EXPECT_EQ(world.files(), 1U);
    EXPECT_TRUE(fs::exists(World::upload('a').file_in(world.spool)));
}

TEST(UploadQueue, ListsTheUploadsOfOneOwner) {
    World world;
    world.send(World::upload('a'));
    world.send(World::upload('b', "ben"));
    world.send(World::upload('c'));
    const auto own = latest_uploads(world.uploads, "anna", 10);
    ASSERT_EQ(own.size(), 2U);
    EXPECT_EQ(own[0].sha256, std::string(64, 'c'));
    EXPECT_EQ(latest_uploads(world.uploads, "", 2).size(), 2U);
    EXPECT_EQ(latest_uploads(world.uploads, "", 10).size(), 3U);
}

} // namespace
} // namespace macadam::testing
