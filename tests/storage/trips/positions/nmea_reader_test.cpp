#include "storage/trips/positions/nmea_reader.hpp"

#include "storage/trips/trip_reader.hpp"
#include "support/files/files.hpp"
#include "support/program/places.hpp"
#include "support/roads/walked_trips.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

namespace fs = std::filesystem;

/// "$...*hh"
std::string sentence(std::string_view content) {
    unsigned sum = 0;
    for (const char c : content) {
        sum ^= static_cast<unsigned char>(c);
    }
    return fmt::format("${}*{:02X}\r\n", content, sum);
}

TripLog read(const std::string& content, const std::string& name = "drive.nmea") {
    return read_trip({.file = written(test_folder(), name, content), .member = {}},
                     needs_of_match());
}

std::size_t count_of(const TripLog& trip, RowReason reason) {
    return static_cast<std::size_t>(std::ranges::count(trip.rows, code(reason)));
}

TEST(Nmea, JoinsTheSentencesOfOneTimeToAFix) {
    const auto trip =
        read(sentence("GPGGA,100000.00,4730.0000,N,00815.0000,W,2,08,0.8,400,M,,M,,") +
             sentence("GPRMC,100000.00,A,4730.0000,N,00815.0000,W,10.0,90.0,010526,,") +
             sentence("GPVTG,91.5,T,,M,10.0,N,18.52,K"));
    ASSERT_THAT(trip.fixes, SizeIs(1));
    EXPECT_DOUBLE_EQ(trip.fixes[0].at.lat_deg, 47.5);
    EXPECT_DOUBLE_EQ(trip.fixes[0].at.lon_deg, -8.25);
    EXPECT_FLOAT_EQ(trip.fixes[0].speed_mps, 18.52F / 3.6F);
    EXPECT_FLOAT_EQ(trip.fixes[0].course_deg, 90); // of RMC, which goes before VTG
    EXPECT_FLOAT_EQ(trip.fixes[0].accuracy_m, 4);  // 0.8 times 5 m
    EXPECT_EQ(trip.meta.t0_utc_s, 1777629600);     // date -d 2026-05-01T10:00:00Z +%s
    EXPECT_EQ(trip.meta.trip_id, "drive");
    EXPECT_THAT(trip.rows, SizeIs(3));
    EXPECT_EQ(count_of(trip, RowReason::merged), 2U);
}

TEST(Nmea, CountsLinesWithAWrongChecksumOrNumberAndOtherSentences) {
    const auto good = sentence("GNRMC,100000,A,4730,N,00815,E,10,90,010526,,");
    const auto trip = read(good + "$GNRMC,100001,A,4730,N,00815,E,10,90,010526,,*00\n" +
                           "$GNRMC,100002,A,4730,N,008\n" + "foobar\n" +
                           sentence("GNRMC,100003,A,4790,N,00815,E,10,90,010526,,") +
                           sentence("GNRMC,100004,A,47x0,N,00815,E,10,90,010526,,") +
                           sentence("GPGSV,1,1,00") + sentence("PUBX,00,1"));
    EXPECT_THAT(trip.fixes, SizeIs(1));
    EXPECT_THAT(trip.rows, SizeIs(8));
    EXPECT_EQ(count_of(trip, RowReason::bad_number), 5U);
    EXPECT_EQ(count_of(trip, RowReason::unused_channel), 2U);
}

TEST(Nmea, TakesTheSpeedOfTheFixAlsoWhereThatOfTheNextFollows) {
    const auto trip = read(sentence("GPVTG,90,T,,M,10.0,N,18.52,K") +
                           sentence("GPRMC,100000,A,4730,N,00815,E,10.0,90.0,010526,,") +
                           sentence("GPVTG,90,T,,M,20.0,N,37.04,K") +
                           sentence("GPRMC,100001,A,4730.01,N,00815,E,20.0,90.0,010526,,"));
    ASSERT_THAT(trip.fixes, SizeIs(2));
    EXPECT_FLOAT_EQ(trip.fixes[0].speed_mps, 18.52F / 3.6F);
    EXPECT_FLOAT_EQ(trip.fixes[1].speed_mps, 37.04F / 3.6F);
}

TEST(Nmea, CountsDatesAndTimesThatAreNoNumbersAsBad) {
    const auto trip = read(sentence("GNRMC,100000,A,4730,N,00815,E,10,90,010526,,") +
                           sentence("GNRMC,100001,A,4730,N,00815,E,10,90,abcdef,,") +
                           sentence("GNRMC,10a002,A,4730,N,00815,E,10,90,010526,,"));
    EXPECT_THAT(trip.fixes, SizeIs(1));
    EXPECT_EQ(count_of(trip, RowReason::bad_number), 2U);
}

TEST(Nmea, GoesPastMidnightAndDatesWhatCameBeforeTheFirstDate) {
    const auto gga = [](std::string_view time, int north) {
        return sentence(fmt::format("GPGGA,{},47{:02},N,00815,E,1,08,1,400,M,,M,,", time, north));
    };
    const auto trip =
        read(gga("235958", 30) + sentence("GPRMC,235959,A,4731,N,00815,E,10,90,310126,,") +
             gga("000001", 32));
    ASSERT_THAT(trip.fixes, SizeIs(3));
    EXPECT_DOUBLE_EQ(trip.fixes[1].t_s, 1);
    EXPECT_DOUBLE_EQ(trip.fixes[2].t_s, 3);
    EXPECT_EQ(trip.meta.t0_utc_s, 1769903998); // date -d 2026-01-31T23:59:58Z +%s
}

TEST(Nmea, HasNoPositionAndNoDateWhereTheReceiverHadNone) {
    const auto trip =
        read(sentence("GPRMC,100000,V,4730,N,00815,E,10,90,010180,,") +
             sentence("GPGGA,100001,,,,,0,00,99,,M,,M,,") + sentence("GPRMC,,V,,,,,,,,,"));
    EXPECT_THAT(trip.fixes, SizeIs(0));
    EXPECT_EQ(trip.meta.t0_utc_s, std::nullopt);
    EXPECT_EQ(count_of(trip, RowReason::no_time), 1U);
}

TEST(Nmea, IsRecognisedInLogAndTextFilesAndBehindTheTimesOfALogger) {
    const auto fix = sentence("GPRMC,100000,A,4730,N,00815,E,10,90,010526,,");
    EXPECT_THAT(read("[12:00:00.1] " + fix, "a.log").fixes, SizeIs(1));
    EXPECT_THAT(read("started\n" + fix, "a.txt").fixes, SizeIs(1));
}

TEST(Nmea, RefusesAFileWithoutAFixAndOneOfWhichMoreIsNeeded) {
    EXPECT_THAT(refusal_of([] { read("$GPRMC,100000,A*00\nfoo\n"); }),
                HasSubstr("2 lines and no RMC or GGA sentence with a correct checksum"));
    const auto file = written(
        test_folder(), "drive.nmea", sentence("GPRMC,100000,A,4730,N,00815,E,10,90,010526,,"));
    EXPECT_THAT(
        refusal_of([&] { read_trip({.file = file, .member = {}}, needs_of_import()); }),
        HasSubstr("is an NMEA recording, which has positions only, expected also vertical"));
}

TEST(Nmea, ReadsWhatGpsBabelWritesOfARealDrive) {
    const auto root = fs::path{source_folder()};
    const auto trip = read_trip({.file = root / "tests/data/positions/gyor.nmea", .member = {}},
                                needs_of_match());
    const auto origin = read_trip(
        {.file = root / "sample_data/gyor/gyor_q3_00.trip.csv", .member = {}}, needs_of_match());
    ASSERT_THAT(trip.fixes, SizeIs(125));
    const auto from = std::ranges::find_if(
        origin.fixes, [](const GnssFix& fix) { return !std::isnan(fix.speed_mps); });
    ASSERT_GE(origin.fixes.end() - from, 125);
    for (std::size_t i = 0; i < trip.fixes.size(); ++i) {
        const auto& fix = *(from + static_cast<std::ptrdiff_t>(i));
        EXPECT_LT(distance_m(trip.fixes[i].at, fix.at), 1.5); // thousandths of a minute
        EXPECT_NEAR(trip.fixes[i].speed_mps, fix.speed_mps, 0.01);
        EXPECT_NEAR(trip.fixes[i].t_s - trip.fixes[0].t_s, fix.t_s - from->t_s, 0.002);
    }
}

TEST(Nmea, IsATripOfAFolderWherePositionsSuffice) {
    const auto folder = test_folder();
    written(folder, "a.nmea", sentence("GPRMC,100000,A,4730,N,00815,E,10,90,010526,,"));
    EXPECT_THAT(find_tracks(folder).trips, SizeIs(1));
    EXPECT_THAT(find_trips(folder).trips, SizeIs(0));
}

} // namespace
} // namespace macadam::testing
