#include "app/serve/live/file_number.hpp"

#include "support/files/files.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

namespace macadam::testing {
namespace {

TEST(FileNumber, StaysWhileAFileIsWrittenAndChangesWithTheFile) {
    const auto folder = test_folder();
    const auto file = folder / "roads.gpkg";
    EXPECT_EQ(file_number(file), 0U);
    written(folder, "roads.gpkg", "one");
    const auto first = file_number(file);
    EXPECT_NE(first, 0U);
    written(folder, "roads.gpkg", "one and more");
    EXPECT_EQ(file_number(file), first);
    std::filesystem::remove(file);
    std::this_thread::sleep_for(std::chrono::milliseconds{50}); // file systems count ticks of 10 ms
    written(folder, "roads.gpkg", "one");                       // of the same inode, on many
    EXPECT_NE(file_number(file), first);
}

} // namespace
} // namespace macadam::testing
