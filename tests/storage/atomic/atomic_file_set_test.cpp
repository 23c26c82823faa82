#include "storage/atomic/atomic_file_set.hpp"

#include "support/files/files.hpp"
#include "support/program/shell.hpp"

#include <gmock/gmock.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::size_t entries_in(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator{folder}, {}));
}

TEST(AtomicFileSet, PutsAllFilesInTheirPlacesAtOnce) {
    const auto folder = test_folder();
    written(folder, "a.dbf", "old");
    AtomicFileSet files{folder / "a.shp"};
    written(files.folder(), "a.shp", "1");
    written(files.folder(), "a.dbf", "2");
    EXPECT_EQ(content_of(folder / "a.dbf"), "old");
    EXPECT_FALSE(fs::exists(folder / "a.shp"));
    files.commit();
    EXPECT_EQ(content_of(folder / "a.shp"), "1");
    EXPECT_EQ(content_of(folder / "a.dbf"), "2");
}

TEST(AtomicFileSet, LeavesNothingWithoutCommit) {
    const auto folder = test_folder();
    {
        const AtomicFileSet files{folder / "a.shp"};
        written(files.folder(), "a.shp", "1");
    }
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST(AtomicFileSet, RemovesWhatTheNewFilesMakeWrong) {
    const auto folder = test_folder();
    written(folder, "a.qix", "index");
    written(folder, "b.qix", "of another");
    {
        AtomicFileSet files{folder / "a.shp"};
        written(files.folder(), "a.shp", "1");
        files.commit({"a.qix", "a.sbn"});
    }
    EXPECT_FALSE(fs::exists(folder / "a.qix"));
    EXPECT_EQ(entries_in(folder), 2U); // a.shp and b.qix
}

TEST(AtomicFileSet, PutsBackWhatWasThereIfOneFileFindsNoPlace) {
    const auto folder = test_folder();
    written(folder, "a.dbf", "old");
    fs::create_directory(folder / "a.shx");
    written(folder / "a.shx", "precious", "1");
    {
        AtomicFileSet files{folder / "a.shp"};
        for (const auto* name : {"a.dbf", "a.shp", "a.shx"}) {
            written(files.folder(), name, "new");
        }
        EXPECT_THAT(refusal_of([&] { files.commit(); }),
                    HasSubstr("a.shx: cannot be written: Is a directory"));
    }
    EXPECT_EQ(content_of(folder / "a.dbf"), "old");
    EXPECT_EQ(content_of(folder / "a.shx" / "precious"), "1");
    EXPECT_FALSE(fs::exists(folder / "a.shp"));
    EXPECT_EQ(entries_in(folder), 2U);
}

TEST(AtomicFileSet, RefusesAPlaceWhereNothingCanBeWritten) {
    const auto folder = test_folder();
    EXPECT_THAT(refusal_of([&] { AtomicFileSet{folder / "none" / "a.shp"}; }),
                HasSubstr("a.shp: cannot be written: No such file or directory"));
    EXPECT_THAT(refusal_of([&] { AtomicFileSet{folder}; }), HasSubstr("Is a directory"));
}

} // namespace
} // namespace macadam::testing
