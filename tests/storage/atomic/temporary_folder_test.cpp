#include "storage/atomic/temporary_folder.hpp"

#include "storage/atomic/atomic_file.hpp"
#include "storage/atomic/atomic_file_set.hpp"
#include "support/files/files.hpp"
#include "support/program/fork.hpp"
#include "support/program/shell.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <set>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

std::vector<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator{folder}) {
        names.insert(entry.path().filename().string());
    }
    return {names.begin(), names.end()};
}

/// What a process leaves that does this and is gone without a word.
template <typename Deed>
void do_and_die(const Deed& deed) {
    const pid_t child = fork_without_threads();
    if (child == 0) {
        deed();
        ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_EQ(status, 0);
}

TEST(TemporaryFolder, IsOfItsOwnerAloneAndHasANameThatNobodyForesees) {
    const auto folder = test_folder();
    const TemporaryFolder one{folder / "a.shp"};
    const TemporaryFolder other{folder / "a.shp"};
    EXPECT_NE(one.path(), other.path());
    EXPECT_THAT(one.path().filename().string(), StartsWith("a.shp.part-"));
    EXPECT_EQ(one.path().filename().string().size(), std::string{"a.shp.part-"}.size() + 12);
    struct stat status {};
    ASSERT_EQ(::stat(one.path().c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0700U);
}

TEST(TemporaryFolder, LeftByAKilledProgramGoesOnceItIsOldAndNobodyUsesIt) {
    const auto folder = test_folder();
    const auto age = [&](const fs::path& each) {
        fs::last_write_time(each, fs::file_time_type::clock::now() - std::chrono::minutes{2});
    };
    do_and_die([&] {
        for (int i = 0; i < 2; ++i) {
            new TemporaryFolder{folder / "a"};
        }
    });
    const auto left = names_in(folder);
    ASSERT_EQ(left.size(), 2U);
    written(folder / left[0] / "tiles/8", "1.json", "{}");
    age(folder / left[0]);
    written(folder, "b.part-0123456789ab/x", "of another");
    age(folder / "b.part-0123456789ab");
    const TemporaryFolder used{folder / "a"};
    age(used.path());
    remove_old_leftovers_of(folder / "a");
    EXPECT_FALSE(fs::exists(folder / left[0]));
    EXPECT_TRUE(fs::exists(folder / left[1])); // too young
    EXPECT_TRUE(fs::exists(folder / "b.part-0123456789ab"));
    EXPECT_TRUE(fs::exists(used.path()));
}

TEST(TemporaryFolder, OfALinkedFolderStaysWhereNamesInASharedFolderAreCleared) {
    const auto folder = test_folder();
    const auto precious = folder / "home/.part-0123456789ab";
    written(precious, "survey", "1");
    fs::last_write_time(precious, fs::file_time_type::clock::now() - std::chrono::minutes{2});
    fs::create_directory_symlink(folder / "home", folder / "a"); // by another user of /tmp
    remove_old_leftovers_of(folder / "a");
    EXPECT_EQ(content_of(precious / "survey"), "1");
}

TEST(TemporaryFolder, OfANameAsLongAsTheSystemTakesFits) {
    const auto folder = test_folder();
    const std::string longest(255, 'x');
    {
        AtomicFileSet files{folder / longest};
        written(files.folder(), longest, "1");
        files.commit();
    }
    EXPECT_THAT(names_in(folder), ElementsAre(longest));
}

TEST(Leftovers, AreWhatAKilledProgramLeavesWithItsSize) {
    const auto folder = test_folder();
    do_and_die([&] {
        const auto* const files = new AtomicFileSet{folder / "a.shp"};
        written(files->folder(), "a.dbf", "12345");
    });
    written(folder, "b.shp.part-0123456789ab", "of another file");
    const auto left = leftovers_of(folder / "a.shp");
    ASSERT_EQ(left.size(), 1U);
    EXPECT_THAT(left[0].name.filename().string(), StartsWith("a.shp.part-"));
    EXPECT_EQ(left[0].bytes, 5U);
}

TEST(Leftovers, AreNotWhatALivingProgramWorksOn) {
    const auto folder = test_folder();
    const AtomicFileSet files{folder / "a.shp"};
    EXPECT_THAT(leftovers_of(folder / "a.shp"), IsEmpty());
    EXPECT_TRUE(is_worked_on(files.folder()));
}

TEST(Leftovers, AreFoundInAFolderToo) {
    const auto folder = test_folder();
    written(folder / "tiles" / ".part-0123456789ab", "0/0/0.png", "123");
    const auto left = leftovers_of(folder / "tiles/");
    ASSERT_EQ(left.size(), 1U);
    EXPECT_EQ(left[0].name, folder / "tiles" / ".part-0123456789ab");
    EXPECT_EQ(left[0].bytes, 3U);
}

TEST(RemoveUnfinished, TakesAwayAllThatIsBegunAndFollowsNoLink) {
    const auto folder = test_folder();
    written(folder, "precious/file", "1");
    do_and_die([&] {
        const auto* const files = new TemporaryFolder{folder / "tiles"};
        for (int i = 0; i < 500; ++i) { // more than one reading of the folder tells
            written(files->path(), "content/14/" + std::to_string(i) + "/1.png", "x");
        }
        fs::create_directory_symlink(folder / "precious", files->path() / "link");
        remove_unfinished();
    });
    EXPECT_THAT(names_in(folder), ElementsAre("precious"));
    EXPECT_EQ(content_of(folder / "precious" / "file"), "1");
}

TEST(RemoveUnfinished, LeavesWhatMustNotBeLost) {
    const auto folder = test_folder();
    do_and_die([&] {
        auto* const files = new TemporaryFolder{folder / "a.shp"};
        files->keep_if_cut_off();
        remove_unfinished();
    });
    EXPECT_EQ(names_in(folder).size(), 1U);
}

TEST(RemoveUnfinished, LeavesWhatItsParentHasBegun) {
    const auto folder = test_folder();
    const TemporaryFolder files{folder / "a.shp"};
    do_and_die([] { remove_unfinished(); });
    EXPECT_EQ(names_in(folder).size(), 1U);
}

TEST(AtomicFile, TakesThePlaceOfAPlantedLinkAndWritesNothingThroughIt) {
    const auto folder = test_folder();
    written(folder, "precious", "old");
    fs::create_symlink(folder / "precious", folder / "a.csv");
    AtomicFile file{folder / "a.csv"};
    file.write("new");
    file.commit();
    EXPECT_EQ(content_of(folder / "precious"), "old");
    EXPECT_EQ(content_of(folder / "a.csv"), "new");
    EXPECT_FALSE(fs::is_symlink(folder / "a.csv"));
    EXPECT_THAT(names_in(folder), ElementsAre("a.csv", "precious"));
}

TEST(AtomicFile, OfAPlaceThatIsAFolderIsRefused) {
    const auto folder = test_folder();
    written(folder / "a.csv", "file", "1");
    AtomicFile file{folder / "a.csv"};
    EXPECT_THAT(refusal_of([&] { file.commit(); }),
                HasSubstr("a.csv: cannot be written: Is a directory"));
    EXPECT_THAT(names_in(folder), ElementsAre("a.csv"));
}

TEST(AtomicFile, HasTheRightsOfAnOrdinaryFile) {
    const auto folder = test_folder();
    const auto ordinary = written(folder, "ordinary", "1");
    AtomicFile file{folder / "a.csv"};
    file.commit();
    EXPECT_EQ(fs::status(folder / "a.csv").permissions(), fs::status(ordinary).permissions());
}

TEST(AtomicFileSet, OfTwoProgramsAtOnceIsWhollyThatOfOne) {
    const auto folder = test_folder();
    const auto write_often = [&](const std::string& whose) {
        for (int i = 0; i < 50; ++i) {
            AtomicFileSet files{folder / "a.shp"};
            for (const auto* name : {"a.dbf", "a.shp", "a.shx"}) {
                written(files.folder(), name, whose);
            }
            files.commit();
        }
    };
    const pid_t other = fork_without_threads();
    if (other == 0) {
        write_often("other");
        ::_exit(0);
    }
    write_often("one");
    ASSERT_EQ(::waitpid(other, nullptr, 0), other);
    EXPECT_EQ(content_of(folder / "a.dbf"), content_of(folder / "a.shp"));
    EXPECT_EQ(content_of(folder / "a.shx"), content_of(folder / "a.shp"));
    EXPECT_THAT(names_in(folder), ElementsAre("a.dbf", "a.shp", "a.shx"));
}

TEST(AtomicFileSet, OfANewFileTakesThePlaceOfNoOther) {
    const auto folder = test_folder();
    AtomicFileSet files{folder / "a.gpkg"};
    written(files.folder(), "a.gpkg", "new");
    written(folder, "a.gpkg", "of another program");
    EXPECT_THAT(refusal_of([&] { files.commit_new(); }),
                HasSubstr("a.gpkg: was created by another program in the meantime"));
    EXPECT_EQ(content_of(folder / "a.gpkg"), "of another program");
}

} // namespace
} // namespace macadam::testing
