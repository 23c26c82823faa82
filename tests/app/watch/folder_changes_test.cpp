#include "app/watch/folder_changes.hpp"

#include "app/watch/settled_trips.hpp"
#include "support/program/program.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <thread>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

TEST(FolderChanges, NameFilesThatWereWrittenOrMovedInAtAnyDepth) {
    const auto folder = fresh_folder();
    const auto elsewhere = folder / "elsewhere";
    const auto watched = folder / "watched";
    fs::create_directories(watched / "day");
    write_file(elsewhere, "x");
    FolderChanges changes{watched};
    ASSERT_EQ(changes.blindness(), "");
    write_file(watched / "day" / "a", "x");
    fs::rename(elsewhere, watched / "b");
    EXPECT_THAT(changes.wait(10s, {}), UnorderedElementsAre(watched / "day" / "a", watched / "b"));
}

TEST(FolderChanges, AreNoticedInFoldersThatAppear) {
    const auto folder = fresh_folder();
    FolderChanges changes{folder};
    fs::create_directories(folder / "new");
    changes.wait(10s, {});
    write_file(folder / "new" / "a", "x");
    EXPECT_THAT(changes.wait(10s, {}), UnorderedElementsAre(folder / "new" / "a"));
}

TEST(FolderChanges, OfABurstAreTakenTogether) {
    const auto folder = fresh_folder();
    FolderChanges changes{folder};
    std::jthread writer{[&] {
        for (int i = 0; i < 3; ++i) {
            write_file(folder / std::to_string(i), "x");
        }
    }};
    EXPECT_THAT(changes.wait(10s, {}), SizeIs(3));
}

TEST(FolderChanges, AreNoticedInAFolderThatTookThePlaceOfTheWatchedOne) {
    const auto folder = fresh_folder();
    fs::create_directories(folder / "watched");
    FolderChanges changes{folder / "watched"};
    fs::rename(folder / "watched", folder / "moved");
    fs::create_directories(folder / "watched");
    changes.wait(10s, {});
    write_file(folder / "moved" / "a", "x");
    write_file(folder / "watched" / "b", "x");
    EXPECT_THAT(changes.wait(10s, {}), UnorderedElementsAre(folder / "watched" / "b"));
}

TEST(FolderChanges, AreNoticedAgainAfterTheirQueueOverflowed) {
    std::size_t limit = 0;
    std::ifstream{"/proc/sys/fs/inotify/max_queued_events"} >> limit;
    ASSERT_GT(limit, 0U);
    const auto folder = fresh_folder();
    write_file(folder / "a", "x");
    write_file(folder / "b", "x");
    FolderChanges changes{folder};
    for (std::size_t i = 0; i <= limit; ++i) { // alternately: equal ones are merged
        std::ofstream{folder / (i % 2 == 0 ? "a" : "b")};
    }
    fs::create_directories(folder / "unnoticed");
    changes.wait(10s, {});
    write_file(folder / "unnoticed" / "c", "x");
    EXPECT_THAT(changes.wait(10s, {}), UnorderedElementsAre(folder / "unnoticed" / "c"));
}

TEST(FolderChanges, AreWaitedForByTimeAloneWithoutInotify) {
    const auto folder = fresh_folder();
    FolderChanges changes{folder, "is on a network file system"};
    EXPECT_EQ(changes.blindness(), "is on a network file system");
    SettledTrips trips{folder, {}};
    const auto now = SettledTrips::Clock::now();
    write_file(folder / "a.rawlog", "x");
    EXPECT_THAT(trips.take(changes.wait(1ms, {}), now), IsEmpty());
    EXPECT_THAT(trips.take(changes.wait(1ms, {}), now + SettledTrips::settling),
                ElementsAre(folder / "a.rawlog"));
}

TEST(FolderChanges, AreNotWaitedForAfterAStopRequest) {
    FolderChanges changes{fresh_folder()};
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THAT(changes.wait(24h, stop.get_token()), IsEmpty());
}

} // namespace
} // namespace macadam::testing
