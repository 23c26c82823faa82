#include "storage/trips/archived_trips.hpp"

#include "storage/files/archive.hpp"
#include "storage/trips/trip_reader.hpp"
#include "support/files/compressed.hpp"
#include "support/files/files.hpp"
#include "support/roads/walked_trips.hpp"

#include <gmock/gmock.h>

#include <fmt/format.h>

using namespace macadam;
using namespace macadam::testing;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

namespace {

const std::vector<std::string> formats{"zip", "tar", "tar.gz", "tar.zst"};

std::string log_of(int rows) {
    std::string text = "# macadam-trip 1\nt_s\n";
    for (int i = 0; i < rows; ++i) {
        text += fmt::format("{}\n", i);
    }
    return text + fmt::format("# end rows: {}\n", rows);
}

/// What becomes of each trip: its rows, or why it cannot be read.
std::vector<std::string> told(const std::filesystem::path& file,
                              const TripWalkConfig& config = {}) {
    std::vector<std::string> all;
    for (const auto& trip : walked(file, config).trips) {
        const auto words = refusal_of([&] { read_trip(trip, {}); });
        all.push_back(!words.empty() ? words : fmt::format("{}", read_trip(trip, {}).rows.size()));
    }
    return all;
}

const std::string acc_csv = "Time (s),X (m/s^2),Y (m/s^2),Z (m/s^2)\n0,0,0,9.8\n";
const std::string place_csv = "Time (s),Latitude (deg),Longitude (deg)\n0,48,15\n";

} // namespace

TEST(ArchivedTrips, OfOneNameAreTwoTrips) {
    for (const auto& format : formats) {
        const auto file =
            written(test_folder(),
                    "a." + format,
                    archive_of(format, {{"a.trip.csv", log_of(1)}, {"a.trip.csv", log_of(2)}}));
        EXPECT_THAT(told(file), ElementsAre("1", "2")) << format;
    }
}

TEST(ArchivedTrips, AreNoMoreThanAThousandFilesUnlessMoreAreAskedFor) {
    const std::vector<std::pair<std::string, std::string>> members{
        {"a.trip.csv", log_of(1)}, {"b.txt", "x"}, {"c.trip.csv", log_of(3)}};
    for (const auto& format : formats) {
        const auto file = written(test_folder(), "a." + format, archive_of(format, members));
        EXPECT_THAT(told(file, {.max_files = 3}), ElementsAre("1", "3")) << format;
        EXPECT_THAT(told(file, {.max_files = 2}),
                    ElementsAre("1",
                                file.string() + ": contains more than 2 files; --max-members N "
                                                "raises the limit"))
            << format;
    }
    EXPECT_EQ(TripWalkConfig{}.max_files, 1000U);
}

TEST(ArchivedTrips, ThatGrowTooMuchAreRefusedAndTheOthersAreNot) {
    const std::string zeros(20 << 20, '\0'); // beyond the 16 MiB that may grow at will
    const auto zip =
        written(test_folder(),
                "a.zip",
                archive_of("zip", {{"bomb.trip.csv", zeros}, {"good.trip.csv", log_of(1)}}));
    const auto words = told(zip);
    ASSERT_THAT(words, Not(IsEmpty()));
    EXPECT_THAT(words.front(),
                EndsWith("a.zip/bomb.trip.csv: grows more than 100-fold when decompressed, "
                         "which no trip log does"));
}

TEST(ArchivedTrips, AreRefusedWhereTheArchiveGrowsTooMuchByWhatIsNoTrip) {
    const std::string zeros(20 << 20, '\0');
    for (const std::string format : {"tar.gz", "tar.zst"}) {
        const auto file =
            written(test_folder(),
                    "a." + format,
                    archive_of(format, {{"notes.txt", zeros}, {"good.trip.csv", log_of(1)}}));
        EXPECT_THAT(told(file),
                    ElementsAre(EndsWith(format + ": grows more than 100-fold when "
                                                  "decompressed, which no trip log does")));
    }
}

TEST(ArchivedTrips, AreRefusedWhereManyFilesTogetherGrowTooMuch) {
    const std::string part(4 << 20, '\n'); // no one of them beyond what may grow at will
    std::vector<std::pair<std::string, std::string>> members;
    for (int i = 0; i < 6; ++i) {
        members.emplace_back(fmt::format("{}.trip.csv", i), "# macadam-trip 1\n" + part);
    }
    const auto file = written(test_folder(), "a.zip", archive_of("zip", members));
    EXPECT_THAT(told(file).back(), HasSubstr("grows more than 100-fold when decompressed"));
}

TEST(ArchivedTrips, WithinAnArchiveOfTheirOwnAreNotRead) {
    const auto inner = archive_of("zip", {{"a.trip.csv", log_of(1)}});
    for (const auto& format : formats) {
        const auto file =
            written(test_folder(),
                    "a." + format,
                    archive_of(format, {{"in/b.zip", inner}, {"c.trip.csv", log_of(2)}}));
        EXPECT_THAT(told(file),
                    ElementsAre(file.string() + "/in/b.zip: is an archive within an archive, "
                                                "which is not supported; expected it beside "
                                                "the other",
                                "2"))
            << format;
    }
}

TEST(ArchivedTrips, BeforeADamageAreRead) {
    const std::string noise = [] {
        std::string text;
        for (unsigned i = 0, x = 1; i < 200'000; ++i) {
            x = x * 1664525U + 1013904223U;
            text += static_cast<char>('0' + (x >> 24) % 64);
        }
        return text;
    }();
    const auto whole = archive_of("tar.gz", {{"a.trip.csv", log_of(1)}, {"b.trip.csv", noise}});
    const auto file = written(test_folder(), "a.tar.gz", whole.substr(0, whole.size() / 2));
    const auto words = told(file);
    ASSERT_THAT(words, SizeIs(::testing::Ge(2U)));
    EXPECT_EQ(words[0], "1");
    EXPECT_THAT(words[1], HasSubstr("the archive is truncated or damaged"));
}

TEST(ArchivedTrips, OfSeveralFilesAreWaitedForWhereverTheyStand) {
    const auto file = written(test_folder(),
                              "a.zip",
                              archive_of("zip",
                                         {{"x/Location.csv", place_csv},
                                          {"y/Accelerometer.csv", acc_csv},
                                          {"x/Accelerometer.csv", acc_csv},
                                          {"y/Location.csv", place_csv}}));
    std::vector<std::string> ids;
    for (const auto& trip : find_trips(file).trips) {
        ids.push_back(read_trip(trip, {}).meta.trip_id);
    }
    EXPECT_THAT(ids, UnorderedElementsAre("x", "y"));
}

TEST(ArchivedTrips, OfSeveralFilesInOneFolderAreTwoWhereTheirFilesAre) {
    const auto file = written(test_folder(),
                              "a.zip",
                              archive_of("zip",
                                         {{"x/Accelerometer.csv", acc_csv},
                                          {"x/Location.csv", place_csv},
                                          {"x/Accelerometer.csv", acc_csv + "0.1,0,0,9.9\n"},
                                          {"x/Location.csv", place_csv}}));
    EXPECT_THAT(told(file), ElementsAre("2", "3"));
}
