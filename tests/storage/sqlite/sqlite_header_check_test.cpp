#include "storage/sqlite/sqlite_header_check.hpp"

#include "storage/sqlite/sqlite.hpp"
#include "support/files/files.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;

/// Tests from another process, as locks of this one do not show here, whether this one holds a
/// lock on a file.
bool is_locked_by_us(const std::filesystem::path& file) {
    const auto child = ::fork();
    if (child == 0) {
        const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
        struct flock wanted {};
        wanted.l_type = F_WRLCK;
        wanted.l_whence = SEEK_SET; // from 0 to the end
        const bool is_told = descriptor >= 0 && ::fcntl(descriptor, F_GETLK, &wanted) == 0;
        ::_exit(is_told && wanted.l_type != F_UNLCK ? 1 : 0);
    }
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status));
    return WEXITSTATUS(status) == 1;
}

TEST(SqliteHeaderCheck, KeepsTheLocksOfThisProcess) {
    const auto file = test_folder() / "a.db";
    Database{file, Database::Access::create}.run("CREATE TABLE number (id INTEGER PRIMARY KEY)");
    Database database{file, Database::Access::write};
    database.enable_wal(std::chrono::seconds{1});
    EXPECT_EQ(database.number("SELECT count(*) FROM number"), 0);
    ASSERT_TRUE(is_locked_by_us(file)); // in WAL mode from the first read until it is closed
    expect_store_file(file);
    EXPECT_TRUE(is_locked_by_us(file));
}

TEST(SqliteHeaderCheck, TellsWhatOtherFilesAre) {
    const auto refusal_for = [](std::string_view content) {
        const auto file = written(test_folder(), "a.gpkg", content);
        return refusal_of([&] { expect_store_file(file); });
    };
    EXPECT_THAT(refusal_for(""), HasSubstr("is empty, not a Macadam database"));
    EXPECT_THAT(refusal_for("%PDF"), HasSubstr("is a PDF"));
    EXPECT_THAT(refusal_for(std::string(1000, 'x')), HasSubstr("is a text file"));
}

} // namespace
} // namespace macadam::testing
