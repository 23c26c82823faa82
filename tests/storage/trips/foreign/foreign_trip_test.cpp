#include "storage/trips/mappings/column_mapping_file.hpp"
#include "storage/trips/trip_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/trips/log/longest_increasing_subsequence.hpp"
#include "support/files/compressed.hpp"
#include "support/files/files.hpp"
#include "support/program/places.hpp"
#include "support/roads/walked_trips.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace macadam;
using namespace macadam::testing;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::SizeIs;

namespace {

namespace fs = std::filesystem;

const TripNeeds everything{.acc = true, .gyro = true, .speed = true, .fixes = true};
const fs::path loggers = fs::path{source_folder()} / "tests/data/loggers";

const std::string acc_csv = "\"Time (s)\",\"X (m/s^2)\",\"Y (m/s^2)\",\"Z (m/s^2)\"\n"
                            "0.0E0,0.1,0.2,9.8\n1.0E-2,0.1,0.2,9.9\n";
const std::string location_csv =
    "\"Time (s)\",\"Latitude (°)\",\"Longitude (°)\",\"Height (m)\",\"Velocity (m/s)\","
    "\"Direction (°)\",\"Horizontal Accuracy (m)\"\n0.5,47.7,17.6,110,12.5,-1,5\n";

fs::path phyphox_folder(const fs::path& folder) {
    written(folder, "Accelerometer.csv", acc_csv);
    written(folder, "Location.csv", location_csv);
    return folder;
}

std::shared_ptr<const TripMapping> mapping(const std::string& toml) {
    return std::make_shared<const TripMapping>(
        read_mapping(written(test_folder(), "m.toml", toml).string()));
}

const std::string small_mapping = "[time]\ncolumn = \"t\"\nformat = \"s\"\n"
                                  "[channels]\nacc_z_mps2 = {column = \"az\"}\n";

std::string mapping_refusal(const std::string& toml) {
    return refusal_of([&] { mapping(toml); });
}

TripLog mapped(const std::string& name, const std::string& file) {
    const auto of = std::make_shared<const TripMapping>(read_mapping(name));
    return read_trip(find_trips(loggers / file, of).trips.at(0), everything);
}

/// By trying all sets.
std::size_t longest_rise_by_force(const std::vector<double>& values) {
    std::size_t longest = 0;
    for (unsigned set = 0; set < (1U << values.size()); ++set) {
        std::vector<double> chosen;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if ((set >> i & 1U) != 0) {
                chosen.push_back(values[i]);
            }
        }
        const bool rises = std::ranges::adjacent_find(chosen, std::greater_equal{}) == chosen.end();
        longest = rises ? std::max(longest, chosen.size()) : longest;
    }
    return longest;
}

} // namespace

TEST(LongestRise, IsAsLongAsAnyAndRises) {
    std::mt19937 random{7};
    for (int round = 0; round < 200; ++round) {
        std::vector<double> values(1 + random() % 9);
        std::ranges::generate(values, [&] { return static_cast<double>(random() % 6); });
        const auto member = longest_increasing_subsequence(values);
        std::vector<double> chosen;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (member[i] != 0) {
                chosen.push_back(values[i]);
            }
        }
        EXPECT_EQ(std::ranges::adjacent_find(chosen, std::greater_equal{}), chosen.end());
        EXPECT_EQ(chosen.size(), longest_rise_by_force(values));
    }
}

TEST(LongestRise, PrefersWhatComesFirst) {
    EXPECT_THAT(longest_increasing_subsequence({0, 2, 1}), ElementsAre(1, 1, 0));
    EXPECT_THAT(longest_increasing_subsequence({5, 5, 6}), ElementsAre(1, 0, 1));
}

TEST(PhyphoxExport, IsATripWithEveryRowOfItsFiles) {
    const auto folder = phyphox_folder(test_folder() / "monday");
    const auto search = find_trips(folder);
    ASSERT_THAT(search.trips, SizeIs(1));
    EXPECT_EQ(search.other_files, 0U);
    const auto trip = read_trip(search.trips[0], needs_of_import());
    EXPECT_EQ(trip.meta.trip_id, "monday");
    EXPECT_EQ(trip.meta.vehicle_id, "");
    EXPECT_EQ(trip.meta.frame, Frame::sensor);
    EXPECT_TRUE(trip.meta.mount_auto);
    EXPECT_FALSE(trip.meta.t0_utc_s);
    EXPECT_THAT(trip.rows, ElementsAre(row_content::acc, row_content::acc, row_content::fix));
    EXPECT_THAT(trip.acc.z, ElementsAre(9.8F, 9.9F));
    EXPECT_EQ(trip.fixes[0].speed_mps, 12.5F);
    EXPECT_TRUE(std::isnan(trip.fixes[0].course_deg));
}

TEST(PhyphoxExport, IsReadBesideADamagedFileThatItDoesNotNeed) {
    const auto folder = phyphox_folder(test_folder() / "phone");
    written(folder, "Pressure.csv", "\x1f\x8b\x08 is not gzip");
    const auto found = find_trips(folder);
    ASSERT_THAT(found.trips, SizeIs(1));
    EXPECT_THAT(read_trip(found.trips[0], everything).acc.t_s, SizeIs(2));
}

TEST(PhyphoxExport, HasOneHashAsFolderAndAsZip) {
    const auto folder = test_folder();
    const auto in_folder = find_trips(phyphox_folder(folder / "a")).trips.at(0);
    const auto zip = written(folder,
                             "b.zip",
                             archive_of("zip",
                                        {{"Location.csv", location_csv},
                                         {"Linear Accelerometer.csv", acc_csv},
                                         {"Accelerometer.csv", acc_csv}}));
    const auto in_zip = find_trips(zip).trips.at(0);
    EXPECT_EQ(OpenTrip{in_folder}.sha256(), OpenTrip{in_zip}.sha256());
    EXPECT_EQ(read_trip(in_zip, needs_of_import()).sha256, OpenTrip{in_zip}.sha256());
    EXPECT_EQ(read_trip(in_zip, needs_of_import()).meta.trip_id, "b");
}

TEST(PhyphoxExport, IsFoundAmongOthersUnderAFolder) {
    const auto folder = test_folder();
    phyphox_folder(folder / "week/monday");
    phyphox_folder(folder / "week/tuesday");
    written(folder, "week/notes.txt", "x");
    written(
        folder,
        "phone.zip",
        archive_of("zip", {{"x/Accelerometer.csv", acc_csv}, {"x/Location.csv", location_csv}}));
    const auto search = find_trips(folder);
    std::vector<std::string> names;
    for (const auto& trip : search.trips) {
        names.push_back(read_trip(trip, needs_of_import()).meta.trip_id);
    }
    EXPECT_THAT(names, ElementsAre("x", "monday", "tuesday"));
    EXPECT_EQ(search.other_files, 1U);
    EXPECT_EQ(search.first_other_file, "week/notes.txt");
}

TEST(PhyphoxExport, ReadsSemicolonsAndDecimalCommas) {
    const auto folder = test_folder();
    written(folder, "Accelerometer.csv", "Time (s);X (m/s^2);Y (m/s^2);Z (m/s^2)\n0,5;1,5;2;9,8\n");
    const auto trip = read_trip(find_trips(folder).trips.at(0), everything);
    EXPECT_THAT(trip.acc.x, ElementsAre(1.5F));
}

TEST(PhyphoxExport, WithoutAPlaceOrAnAccelerationIsRefused) {
    const auto folder = test_folder();
    written(folder, "Accelerometer.csv", acc_csv);
    EXPECT_THAT(refusal_of([&] { read_trip(find_trips(folder).trips.at(0), needs_of_import()); }),
                HasSubstr("expected one"));
}

TEST(PhyphoxExport, OfAnotherAppIsRefusedWithItsHeader) {
    const auto folder = test_folder();
    written(folder, "Accelerometer.csv", "millis,ax,ay,az\n0,0,0,9.8\n");
    EXPECT_THAT(refusal_of([&] { read_trip(find_trips(folder).trips.at(0), everything); }),
                EndsWith("Accelerometer.csv:1: the header has 'millis,ax,ay,az', expected that of "
                         "phyphox ('Time (s)') or of Sensor Logger ('seconds_elapsed')"));
}

TEST(Mapping, ReadsRaceChrono) {
    const auto trip = mapped("racechrono", "racechrono.csv");
    EXPECT_THAT(trip.rows, SizeIs(60));
    // Its first row: 1767150797.44,...,31.0781678,121.1164132,8.0,33.453,...,0.35977,...,0.36255
    EXPECT_NEAR(trip.meta.t0_utc_s.value(), 1767150797.44, 1e-3);
    EXPECT_EQ(trip.fixes[0].at, (GeoPoint{31.0781678, 121.1164132}));
    EXPECT_EQ(trip.fixes[0].speed_mps, 33.453F);
    EXPECT_NEAR(trip.acc.y[0], 0.35977 * 9.80665, 1e-5);
    EXPECT_NEAR(trip.acc.x[0], 0.36255 * 9.80665, 1e-5);
    EXPECT_NEAR(trip.acc.t_s[1], 0.02, 1e-6);
    EXPECT_FALSE(trip.meta.gravity_included);
}

TEST(Mapping, ReadsTrackAddict) {
    const auto trip = mapped("trackaddict", "trackaddict.csv");
    EXPECT_THAT(trip.rows, SizeIs(60));
    // Its first row:
    // ...,1559734411.007,...,51.9970176,13.6845468,28.9,95,74.4,200.3,24.0,-0.45,-0.15
    EXPECT_NEAR(trip.meta.t0_utc_s.value(), 1559734411.007, 1e-3);
    EXPECT_NEAR(trip.fixes[0].speed_mps, 74.4 / 3.6, 1e-5);
    EXPECT_EQ(trip.fixes[0].accuracy_m, 24);
    EXPECT_NEAR(trip.acc.x[0], -0.15 * 9.80665, 1e-5);
    EXPECT_NEAR(trip.acc.y[0], -0.45 * 9.80665, 1e-5);
    EXPECT_LT(trip.fixes.size(), 10U); // one a second; the rows between repeat it
}

TEST(Mapping, TakesEveryFittingFileUnderAFolder) {
    const auto of = mapping("files = \"*_acc.csv\"\n" + small_mapping);
    const auto folder = test_folder() / "logs";
    for (const auto* const name : {"b_acc.csv", "d/a_acc.csv", "b_gps.csv"}) {
        written(folder, name, "t,az\n0,9.8\n");
    }
    const auto search = find_trips(folder, of);
    ASSERT_THAT(search.trips, SizeIs(2));
    EXPECT_EQ(search.other_files, 1U);
    EXPECT_EQ(search.first_other_file, "b_gps.csv");
    EXPECT_EQ(read_trip(search.trips[0], everything).meta.trip_id, "b_acc");
    EXPECT_EQ(OpenTrip{search.trips[0]}.sha256(), read_trip(search.trips[0], everything).sha256);
}

TEST(Mapping, MissesAFileThatShouldLieBeside) {
    const auto of = mapping("files = \"*_acc.csv\"\n" + small_mapping +
                            "[[file]]\nfiles = \"*_gps.csv\"\n[file.time]\ncolumn = \"t\"\n"
                            "format = \"s\"\n[file.channels]\nlat_deg = {column = \"lat\"}\n");
    const auto file = written(test_folder() / "logs", "b_acc.csv", "t,az\n0,9.8\n");
    EXPECT_THAT(refusal_of([&] { find_trips(file, of); }),
                EndsWith("b_gps.csv: no such file, expected it beside b_acc.csv"));
}

TEST(Mapping, NamesTheMeasurementsThatItDoesNotGive) {
    const auto of = mapping(small_mapping);
    const auto file = written(test_folder() / "logs", "x.csv", "t,az\n0,9.8\n1,9.8\n");
    EXPECT_THAT(refusal_of([&] { read_trip(find_trips(file, of).trips.at(0), needs_of_import()); }),
                HasSubstr("m.toml, which gives no speed of the car or of the receiver; position "
                          "(latitude, longitude), "
                          "expected speed_mps or gnss_speed_mps and lat_deg and lon_deg"));
}

TEST(Mapping, ScalesCountsOfTimeAndNoDates) {
    const std::string channels = "[channels]\nacc_z_mps2 = {column = \"az\"}\n";
    const auto of = mapping("[time]\ncolumn = \"t\"\nformat = \"ms\"\nscale = 0.1\n" + channels);
    const auto file = written(test_folder() / "logs", "x.csv", "t,az\n0,9.8\n100,9.8\n");
    EXPECT_THAT(read_trip(find_trips(file, of).trips.at(0), everything).acc.t_s,
                ElementsAre(0, 0.01));
    EXPECT_THAT(mapping_refusal("[time]\ncolumn = \"t\"\nformat = \"iso\"\nscale = 2\n" + channels),
                HasSubstr("no such key except for the formats s, ms, us and ns"));
}

TEST(Mapping, ReadsColumnsByNumberWithoutAHeader) {
    const auto of = mapping("header = false\nseparator = \"blank\"\nskip_lines = 1\n"
                            "[time]\ncolumn = 1\nformat = \"ms\"\n"
                            "[channels]\nacc_z_mps2 = {column = 3}\n");
    const auto file = written(test_folder() / "logs", "x.dat", "junk\n0  1 9.8\n10  2   9.9\n");
    const auto trip = read_trip(find_trips(file, of).trips.at(0), everything);
    EXPECT_THAT(trip.acc.t_s, ElementsAre(0, 0.01));
    EXPECT_THAT(trip.acc.z, ElementsAre(9.8F, 9.9F));
}

TEST(Mapping, SaysWhichColumnTheHeaderLacks) {
    const auto of = mapping(small_mapping);
    const auto file = written(test_folder() / "logs", "x.csv", "t,acc\n0,9.8\n");
    EXPECT_THAT(refusal_of([&] { read_trip(find_trips(file, of).trips.at(0), everything); }),
                EndsWith("x.csv:1: the header has 't,acc', expected a column 'az'"));
}

TEST(PhoneExport, WithoutPlacesIsToldWhichFileItLacks) {
    const auto folder = test_folder() / "phone";
    written(folder, "Accelerometer.csv", acc_csv);
    EXPECT_THAT(
        refusal_of([&] { read_trip(find_trips(folder).trips.at(0), needs_of_trace()); }),
        EndsWith("phone: contains no Location.csv, expected one with positions and speeds"));
}

TEST(PhoneExport, IsAskedForAsAFolderWhereOneOfItsFilesIsGiven) {
    const auto folder = phyphox_folder(test_folder() / "phone");
    EXPECT_THAT(
        refusal_of([&] { read_trip(find_trips(folder / "Accelerometer.csv").trips.at(0), {}); }),
        HasSubstr("Accelerometer.csv: is one file of a phone export, expected its folder"));
}

TEST(Mapping, SaysThatTheUnitOfTimeIsAnother) {
    const auto of = mapping("[time]\ncolumn = \"t\"\nformat = \"s\"\nepoch = \"unix\"\n"
                            "[channels]\nacc_z_mps2 = {column = \"az\"}\n");
    const auto file = written(test_folder() / "logs", "x.csv", "t,az\n1559734411007,9.8\n");
    EXPECT_THAT(refusal_of([&] { read_trip(find_trips(file, of).trips.at(0), everything); }),
                HasSubstr("expected a date from 1990 to 2100; the unit may differ"));
}

TEST(Mapping, RefusesWhatItDoesNotKnowWithItsLine) {
    EXPECT_THAT(mapping_refusal("colour = \"red\"\n" + small_mapping),
                HasSubstr("m.toml:1: unknown key 'colour'"));
    EXPECT_THAT(mapping_refusal(small_mapping + "acc_q = {column = \"q\"}\n"),
                HasSubstr("m.toml:6: unknown key 'channels.acc_q'"));
    EXPECT_THAT(
        mapping_refusal(small_mapping + "speed_mps = {column = \"v\", unit = \"furlong\"}\n"),
        HasSubstr("'furlong', expected one of m/s, km/h, mph"));
    EXPECT_THAT(mapping_refusal("axes = [\"x\", \"x\", \"z\"]\n" + small_mapping),
                HasSubstr("expected x, y and z in some order"));
    EXPECT_THAT(mapping_refusal("frame = \"ENU\"\n" + small_mapping),
                HasSubstr("m.toml:1: key 'frame' is 'ENU', expected FLU, FRD or sensor"));
    EXPECT_THAT(mapping_refusal("[channels]\nacc_z_mps2 = {column = 1}\n"), HasSubstr("time"));
    EXPECT_THAT(
        mapping_refusal("[time]\ncolumn = 1\nformat = \"s\"\n[channels]\nacc_z_mps2 = \"az\"\n"),
        HasSubstr("m.toml:5: 'channels.acc_z_mps2' is 'az', expected {column = \"az\"}"));
}
