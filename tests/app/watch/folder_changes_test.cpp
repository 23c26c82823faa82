#include "app/watch/folder_changes.hpp"

#include "support/program/program.hpp"

#include <gmock/gmock.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::IsEmpty;
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

TEST(FolderChanges, AreNotWaitedForAfterAStopRequest) {
    FolderChanges changes{fresh_folder()};
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THAT(changes.wait(24h, stop.get_token()), IsEmpty());
}

} // namespace
} // namespace macadam::testing
