#include "storage/store/connection/import_lock.hpp"

#include "support/files/files.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <optional>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

struct Place {
    fs::path store;
    fs::path lock;
};

Place new_place() {
    const auto store = test_folder() / "roads.gpkg";
    return {store, store.string() + "-import"};
}

TEST(ImportLock, TellsThatAnImportRunsUntilItEnds) {
    const auto [store, file] = new_place();
    EXPECT_FALSE(is_import_running(store));
    {
        const ImportLock import{store, "a"};
        EXPECT_TRUE(is_import_running(store));
        EXPECT_TRUE(is_import_running(store, "a"));
        EXPECT_FALSE(is_import_running(store, "b"));
    }
    EXPECT_FALSE(is_import_running(store));
    EXPECT_FALSE(fs::exists(file));
}

TEST(ImportLock, OfTheLastOfSeveralImportsRemovesTheFile) {
    const auto [store, file] = new_place();
    std::optional<ImportLock> first;
    std::optional<ImportLock> second;
    first.emplace(store, "a");
    second.emplace(store, "a");
    first.reset();
    EXPECT_TRUE(is_import_running(store, "a"));
    second.reset();
    EXPECT_FALSE(fs::exists(file));
}

TEST(ImportLock, KnowsOtherImportsButNotItself) {
    const auto [store, file] = new_place();
    const ImportLock one{store, "a"};
    EXPECT_FALSE(one.is_other_running());
    {
        const ImportLock other{store, "b"};
        EXPECT_TRUE(one.is_other_running());
        EXPECT_TRUE(one.is_other_running("b"));
        EXPECT_FALSE(one.is_other_running("a"));
        EXPECT_TRUE(other.is_other_running("a"));
    }
    EXPECT_FALSE(one.is_other_running());
}

// The file was left by the killed import of a user whose umask is 022.
TEST(ImportLock, IsTakenOnAFileThatMayOnlyBeRead) {
    const auto [store, file] = new_place();
    std::ofstream{file} << "";
    fs::permissions(file, fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read);
    const auto child = fork();
    if (child == 0) {
        const bool is_other_user = setuid(65534) == 0 || getuid() != 0;
        const ImportLock import{store, "a"};
        _exit(is_other_user && is_import_running(store, "a") ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    EXPECT_FALSE(is_import_running(store));
    EXPECT_TRUE(fs::exists(file));
}

TEST(ImportLock, IsReleasedByTheKernelWhenTheProcessIsKilled) {
    const auto [store, file] = new_place();
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const auto child = fork();
    if (child == 0) {
        const ImportLock import{store, "a"};
        [[maybe_unused]] const auto told = write(ready[1], "x", 1);
        pause();
        _exit(0);
    }
    char byte = 0;
    ASSERT_EQ(read(ready[0], &byte, 1), 1);
    EXPECT_TRUE(is_import_running(store));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    EXPECT_FALSE(is_import_running(store));
    EXPECT_TRUE(fs::exists(file));
    { const ImportLock next{store, "b"}; }
    EXPECT_FALSE(fs::exists(file));
}

TEST(ImportLock, IsKnownThroughASymbolicLinkToTheDatabase) {
    const auto [store, file] = new_place();
    std::ofstream{store} << "x";
    const auto link = store.parent_path() / "link.gpkg";
    fs::create_symlink(store, link);
    const ImportLock import{link, "a"};
    EXPECT_TRUE(fs::exists(file));
    EXPECT_TRUE(is_import_running(store));
}

TEST(ImportLock, FollowsNoLinkAndHasNoEffectWhereItCannotBeWritten) {
    const auto [store, file] = new_place();
    const auto victim = store.parent_path() / "victim";
    fs::create_symlink(victim, file);
    const ImportLock import{store, "a"};
    EXPECT_FALSE(fs::exists(victim));
    EXPECT_FALSE(is_import_running(store));
    EXPECT_FALSE(is_import_running("/nowhere/roads.gpkg"));
}

} // namespace
} // namespace macadam::testing
