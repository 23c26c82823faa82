#include "storage/trips/trip_reader.hpp"

#include "support/files/compressed.hpp"
#include "support/files/files.hpp"
#include "support/roads/walked_trips.hpp"

#include <gmock/gmock.h>

using namespace macadam;
using namespace macadam::testing;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

namespace {

const std::string small_log = "# macadam-trip 1\nt_s\n0\n# end rows: 1\n";

std::vector<std::string> names_of(const WalkedTrips& search, const std::filesystem::path& under) {
    std::vector<std::string> names;
    for (const auto& trip : search.trips) {
        names.push_back(trip.member.empty() ? trip.file.lexically_relative(under).string()
                                            : trip.member);
    }
    return names;
}

} // namespace

TEST(TripWalk, FindsTheTripsUnderAFolderInByteOrder) {
    const auto folder = test_folder();
    for (const auto* const name : {"b.trip.csv",
                                   "a/z.trip.csv.gz",
                                   "a-1.trip.csv.zst",
                                   "B.trip.csv",
                                   "a/notes.txt",
                                   "x.csv"}) {
        written(folder, name, small_log);
    }
    const auto search = find_trips(folder);
    EXPECT_THAT(names_of(search, folder),
                ElementsAre("B.trip.csv", "a-1.trip.csv.zst", "a/z.trip.csv.gz", "b.trip.csv"));
    EXPECT_EQ(search.other_files, 2U);
    EXPECT_EQ(search.first_other_file, "a/notes.txt");
}

TEST(TripWalk, CountsALinkToNothingAsATripThatCannotBeRead) {
    const auto folder = test_folder();
    std::filesystem::create_symlink(folder / "gone.csv", folder / "d.trip.csv");
    std::filesystem::create_symlink(folder / "gone.txt", folder / "notes.txt");
    const auto search = find_trips(folder);
    EXPECT_THAT(names_of(search, folder), ElementsAre("d.trip.csv"));
    EXPECT_EQ(search.other_files, 1U);
    EXPECT_THAT(refusal_of([&] { read_trip(search.trips.at(0), {}); }),
                EndsWith("d.trip.csv: cannot be read: No such file or directory"));
}

TEST(TripWalk, HandsOnAnArchiveThatIsDamagedForTheReaderToSaySo) {
    const auto folder = test_folder();
    written(folder, "cut.zip", std::string{"PK\x03\x04\x14\0\0\0", 8});
    written(folder, "noise.zip", std::string{"\x9a\0\x01\xff\x33", 5});
    const auto search = find_trips(folder);
    ASSERT_EQ(search.trips.size(), 2U);
    for (const auto& trip : search.trips) {
        EXPECT_THAT(refusal_of([&] { read_trip(trip, {}); }),
                    HasSubstr(".zip: the archive is truncated or damaged: "));
    }
}

TEST(TripWalk, TakesAFileForATripWhateverItsName) {
    const auto file = written(test_folder(), "drive.csv", small_log);
    const auto search = find_trips(file);
    ASSERT_EQ(search.trips.size(), 1U);
    EXPECT_EQ(search.trips[0].file, file);
}

TEST(TripWalk, FindsTheTripsInAnArchiveInItsOwnOrder) {
    const auto folder = test_folder();
    for (const std::string format : {"zip", "tar", "tar.gz", "tar.zst"}) {
        const auto file = written(folder,
                                  "a." + format,
                                  archive_of(format,
                                             {{"d/b.trip.csv.gz", gzipped(small_log)},
                                              {"d/notes.txt", "x"},
                                              {"d/a.trip.csv", small_log}}));
        const auto search = find_trips(file);
        EXPECT_THAT(names_of(search, folder), ElementsAre("d/b.trip.csv.gz", "d/a.trip.csv"))
            << format;
        EXPECT_EQ(search.other_files, 1U) << format;
        EXPECT_EQ(search.first_other_file, "d/notes.txt") << format;
        for (const auto& trip : search.trips) {
            EXPECT_EQ(read_trip(trip, {}).rows.size(), 1U) << trip.name();
            EXPECT_EQ(OpenTrip{trip}.sha256(), read_trip(trip, {}).sha256) << trip.name();
        }
    }
}

TEST(TripWalk, ReadsAFileWhoseNamePointsOutOfTheArchiveAndWritesNothing) {
    const auto folder = test_folder();
    for (const std::string name :
         {"../out.trip.csv", "/etc/out.trip.csv", "a/../../out.trip.csv"}) {
        const auto file = written(folder, "in/a.zip", archive_of("zip", {{name, small_log}}));
        const auto search = find_trips(file);
        ASSERT_EQ(search.trips.size(), 1U);
        EXPECT_EQ(search.trips[0].name(), file.string() + "/" + name);
        EXPECT_EQ(read_trip(search.trips[0], {}).rows.size(), 1U);
        EXPECT_FALSE(std::filesystem::exists(folder / "out.trip.csv"));
    }
}

TEST(TripWalk, NamesTheMemberInWhatIsWrongWithIt) {
    const auto file =
        written(test_folder(), "a.zip", archive_of("zip", {{"bad.trip.csv", "bumps\n"}}));
    EXPECT_THAT(refusal_of([&] { read_trip(find_trips(file).trips.at(0), {}); }),
                EndsWith("a.zip/bad.trip.csv:1: 'bumps', expected '# macadam-trip 1': not a "
                         "Macadam log; for other CSV files see 'macadam inspect'"));
}

TEST(TripWalk, RefusesAnArchiveThatIsCutOff) {
    const auto whole = archive_of("tar.gz", {{"a.trip.csv", small_log}});
    const auto file = written(test_folder(), "a.tar.gz", whole.substr(0, whole.size() / 2));
    EXPECT_THAT(refusal_of([&] {
                    for (const auto& trip : find_trips(file).trips) {
                        read_trip(trip, {});
                    }
                }),
                HasSubstr("the archive is truncated or damaged"));
}

TEST(TripWalk, RefusesWhatIsNotThere) {
    EXPECT_THAT(refusal_of([] { find_trips("/nowhere/at/all"); }),
                EndsWith("/nowhere/at/all: no such file or folder"));
}
