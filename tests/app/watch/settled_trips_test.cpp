#include "app/watch/settled_trips.hpp"

#include "estimator/common/error.hpp"
#include "support/program/program.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const SettledTrips::Clock::time_point now = SettledTrips::Clock::now();
const std::string whole = "# macadam-trip 1\nt_s\n0\n# end rows: 1\n";

TEST(SettledTrips, AreTakenAtOnceWhenTheirWriterHasClosedThem) {
    const auto folder = fresh_folder();
    const auto trip = folder / "a.trip.csv";
    write_file(trip, whole);
    SettledTrips trips{folder, {}};
    EXPECT_THAT(trips.take({}, now), IsEmpty());
    EXPECT_TRUE(trips.has_incomplete());
    EXPECT_THAT(trips.take({trip}, now), ElementsAre(trip));
    EXPECT_FALSE(trips.has_incomplete());
}

TEST(SettledTrips, AreTakenWhenTheyDidNotChangeForTenSecondsOrAMinuteAfterTheyGrew) {
    const auto folder = fresh_folder();
    const auto trip = folder / "day" / "a.trip.csv.gz";
    fs::create_directories(trip.parent_path());
    write_file(trip, "one");
    SettledTrips trips{folder, {}};
    EXPECT_THAT(trips.take({}, now), IsEmpty());
    write_file(trip, "three");
    EXPECT_THAT(trips.take({trip}, now + 10s), IsEmpty());
    EXPECT_THAT(trips.take({}, now + 69s), IsEmpty());
    EXPECT_THAT(trips.take({}, now + 70s), ElementsAre(trip));
    const auto other = folder / "other.rawlog";
    write_file(other, "whole");
    EXPECT_THAT(trips.take({other}, now + 80s), IsEmpty());
    EXPECT_THAT(trips.take({}, now + 90s), ElementsAre(other));
}

/// A folder in memory, which knows leases as overlay and network file systems do not.
class MemoryFolder {
public:
    MemoryFolder() : path_{::mkdtemp(name_.data())} {}
    MemoryFolder(const MemoryFolder&) = delete;
    MemoryFolder& operator=(const MemoryFolder&) = delete;
    ~MemoryFolder() { fs::remove_all(path_); }
    const fs::path& path() const { return path_; }

private:
    std::string name_ = "/dev/shm/macadam-test-XXXXXX";
    fs::path path_;
};

TEST(SettledTrips, WaitForAWriterThatStalls) {
    ASSERT_TRUE(fs::is_directory("/dev/shm")) << "Linux has a tmpfs there, where it knows leases";
    const MemoryFolder memory;
    const auto& folder = memory.path();
    const auto trip = folder / "a.trip.csv.gz";
    std::ofstream upload{trip};
    upload << "half" << std::flush;
    SettledTrips trips{folder, {}};
    EXPECT_THAT(trips.take({}, now), IsEmpty());
    EXPECT_THAT(trips.take({}, now + 1h), IsEmpty());
    EXPECT_TRUE(trips.has_incomplete());
    upload.close();
    EXPECT_THAT(trips.take({trip}, now + 1h), ElementsAre(trip));
}

TEST(SettledTrips, AreTakenAtOnceIfTheyAreOldAtTheFirstLook) {
    const auto folder = fresh_folder();
    const auto trip = folder / "a.rawlog";
    write_file(trip, "old");
    fs::last_write_time(trip, fs::file_time_type::clock::now() - 1h);
    SettledTrips trips{folder, {}};
    EXPECT_THAT(trips.take({}, now), ElementsAre(trip));
    const auto unpacked = folder / "b.rawlog"; // unpacking keeps times of change
    write_file(unpacked, "half");
    fs::last_write_time(unpacked, fs::file_time_type::clock::now() - 1h);
    EXPECT_THAT(trips.take({unpacked}, now + 1s), IsEmpty());
}

TEST(SettledTrips, WaitFiveMinutesForTheirEndRow) {
    const auto folder = fresh_folder();
    const auto trip = folder / "a.trip.csv";
    write_file(trip, "# macadam-trip 1\nt_s\n0\n");
    SettledTrips trips{folder, {}};
    EXPECT_THAT(trips.take({trip}, now), IsEmpty());
    EXPECT_THAT(trips.take({}, now + 4min), IsEmpty());
    EXPECT_THAT(trips.take({}, now + 5min), ElementsAre(trip));
}

TEST(SettledTrips, AreReturnedOnceUntilTheyChange) {
    const auto folder = fresh_folder();
    const auto trip = folder / "a.trip.csv";
    write_file(trip, whole);
    SettledTrips trips{folder, {}};
    EXPECT_THAT(trips.take({trip}, now), ElementsAre(trip));
    EXPECT_THAT(trips.take({trip}, now + 1h), IsEmpty());
    write_file(trip, "# more\n" + whole);
    EXPECT_THAT(trips.take({trip}, now + 1h), ElementsAre(trip));
}

TEST(SettledTrips, AreLinksWithoutATargetOnceAndTheirTargetsLater) {
    const auto folder = fresh_folder();
    const auto link = folder / "watched" / "a.rawlog";
    fs::create_directories(link.parent_path());
    fs::create_symlink(folder / "target", link);
    SettledTrips trips{link.parent_path(), {}};
    EXPECT_THAT(trips.take({}, now), IsEmpty());
    EXPECT_THAT(trips.take({}, now + 10s), ElementsAre(link));
    EXPECT_THAT(trips.take({}, now + 20s), IsEmpty());
    EXPECT_FALSE(trips.has_incomplete());
    write_file(folder / "target", "log");
    EXPECT_THAT(trips.take({}, now + 30s), IsEmpty());
    EXPECT_THAT(trips.take({}, now + 90s), ElementsAre(link));
}

TEST(SettledTrips, OfAFolderThatIsGoneAreAnError) {
    SettledTrips trips{fresh_folder() / "gone", {}};
    EXPECT_THROW(trips.take({}, now), InputError);
}

} // namespace
} // namespace macadam::testing
