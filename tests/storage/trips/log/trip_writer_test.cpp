#include "storage/trips/log/trip_writer.hpp"

#include "storage/trips/log/trip_meta.hpp"
#include "storage/trips/trip_reader.hpp"
#include "support/files/compressed.hpp"
#include "support/files/files.hpp"
#include "support/program/places.hpp"

#include <gmock/gmock.h>

#include <cmath>

using namespace macadam;
using namespace macadam::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

namespace {

constexpr TripNeeds everything{.acc = true, .gyro = true, .speed = true, .fixes = true};
constexpr float none = std::numeric_limits<float>::quiet_NaN();

/// One of everything, at times of which some are shared.
TripLog small_trip() {
    TripLog trip;
    trip.meta.trip_id = "a-1";
    trip.meta.vehicle_id = "rav4-7";
    trip.meta.t0_utc_s = 1533226488.225;
    trip.acc = {{0, 0.01, 0.02}, {0.1F, none, -0.25F}, {none, none, none}, {9.81F, 9.5F, 10}};
    trip.gyro = {{0.01}, {0.001F}, {-0.002F}, {0}};
    trip.speed = {{0.005, 0.02}, {7.9743F, -0.5F}};
    trip.fixes = {{0.02, {37.7209977, -122.4723053}, 7.823F, 2.1356F, 1.5F}};
    return trip;
}

std::string content_of(const std::filesystem::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

std::string written_text(const TripLog& trip) {
    const auto file = test_folder() / "a.trip.csv";
    write_trip(trip, file);
    return content_of(file);
}

TripLog read_again(const TripLog& trip, const std::string& name = "a.trip.csv") {
    const auto file = test_folder() / name;
    write_trip(trip, file);
    return read_trip({file, ""}, everything);
}

void expect_near(const std::vector<float>& found, const std::vector<float>& expected, double unit) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(std::isnan(found[i]), std::isnan(expected[i])) << i;
        if (!std::isnan(expected[i])) {
            // half a printed unit, and what a float itself rounds
            EXPECT_NEAR(found[i], expected[i], 0.5 * unit + 1e-7 * std::abs(expected[i])) << i;
        }
    }
}

void expect_same(const TripLog& found, const TripLog& expected) {
    EXPECT_EQ(found.acc.t_s, expected.acc.t_s);
    expect_near(found.acc.x, expected.acc.x, 1e-5);
    expect_near(found.acc.y, expected.acc.y, 1e-5);
    expect_near(found.acc.z, expected.acc.z, 1e-5);
    EXPECT_EQ(found.gyro.t_s, expected.gyro.t_s);
    expect_near(found.gyro.x, expected.gyro.x, 1e-6);
    expect_near(found.gyro.y, expected.gyro.y, 1e-6);
    expect_near(found.gyro.z, expected.gyro.z, 1e-6);
    EXPECT_EQ(found.speed.t_s, expected.speed.t_s);
    expect_near(found.speed.speed_mps, expected.speed.speed_mps, 1e-4);
    ASSERT_EQ(found.fixes.size(), expected.fixes.size());
    for (std::size_t i = 0; i < found.fixes.size(); ++i) {
        const auto& [a, b] = std::pair{found.fixes[i], expected.fixes[i]};
        EXPECT_EQ(a.t_s, b.t_s);
        EXPECT_NEAR(a.at.lat_deg, b.at.lat_deg, 5.1e-9);
        EXPECT_NEAR(a.at.lon_deg, b.at.lon_deg, 5.1e-9);
        expect_near({a.speed_mps, a.course_deg}, {b.speed_mps, b.course_deg}, 1e-4);
        expect_near({a.accuracy_m}, {b.accuracy_m}, 1e-3);
    }
}

} // namespace

TEST(TripWriter, PutsWhatWasSampledAtOnceIntoOneRow) {
    EXPECT_EQ(written_text(small_trip()),
              "# macadam-trip 1\n"
              "# trip_id: a-1\n"
              "# vehicle_id: rav4-7\n"
              "# t0_utc: 2018-08-02T16:14:48.225Z\n"
              "# gravity: included\n"
              "t_s,acc_x_mps2,acc_z_mps2,gyro_x_radps,gyro_y_radps,gyro_z_radps,speed_mps,lat_deg,"
              "lon_deg,gnss_speed_mps,course_deg,hacc_m\n"
              "0.000000,0.10000,9.81000,,,,,,,,,\n"
              "0.005000,,,,,,7.9743,,,,,\n"
              "0.010000,,9.50000,0.001000,-0.002000,0.000000,,,,,,\n"
              "0.020000,-0.25000,10.00000,,,,-0.5000,37.72099770,-122.47230530,7.8230,2.1356,1.500"
              "\n"
              "# end rows: 4\n");
}

TEST(TripWriter, CountsTheRowsThatItWrites) {
    EXPECT_EQ(write_trip(small_trip(), test_folder() / "a.trip.csv"), 4U);
}

TEST(TripWriter, GivesBackTheSamplesToThePrintedDigits) {
    for (const auto* const name : {"a.trip.csv", "a.trip.csv.gz", "a.trip.csv.zst"}) {
        SCOPED_TRACE(name);
        const auto found = read_again(small_trip(), name);
        EXPECT_THAT(found.rows, SizeIs(4));
        expect_same(found, small_trip());
    }
}

TEST(TripWriter, GivesBackTwoRecordedTrips) {
    const std::string samples = source_folder() + "/sample_data/";
    for (const auto* const name :
         {"comma2k19/comma2k19_rav4.trip.csv", "gyor/gyor_q3_00.trip.csv"}) {
        SCOPED_TRACE(name);
        const auto trip = read_trip({samples + name, ""}, everything);
        expect_same(read_again(trip), trip);
    }
}

TEST(TripWriter, CompressesTheSameText) {
    const auto folder = test_folder();
    const auto trip = small_trip();
    std::vector<std::string> hashes;
    for (const auto* const name : {"a.trip.csv", "a.trip.csv.gz", "a.trip.csv.zst"}) {
        write_trip(trip, folder / name);
        hashes.push_back(OpenTrip{{folder / name, ""}}.sha256());
    }
    EXPECT_THAT(hashes, ElementsAre(hashes[0], hashes[0], hashes[0]));
    EXPECT_EQ(content_of(folder / "a.trip.csv.gz").substr(0, 2), "\x1f\x8b");
    EXPECT_EQ(content_of(folder / "a.trip.csv.zst").substr(0, 4), "\x28\xb5\x2f\xfd");
}

TEST(TripWriter, WritesTheSameBytesUnderAnyNameAndAtAnyTime) {
    const auto folder = test_folder();
    for (const std::string suffix : {".trip.csv.gz", ".trip.csv.zst"}) {
        write_trip(small_trip(), folder / ("a" + suffix), 1);
        write_trip(small_trip(), folder / ("other" + suffix), 1);
        EXPECT_EQ(content_of(folder / ("a" + suffix)), content_of(folder / ("other" + suffix)));
    }
    // RFC 1952, 2.3: bytes 4 to 7 are a time, byte 3 says that no name follows
    EXPECT_EQ(content_of(folder / "a.trip.csv.gz").substr(3, 5), std::string(5, '\0'));
}

TEST(TripWriter, ComesBackWithAllThatTheHeadSaid) {
    TripLog trip = small_trip();
    auto& meta = trip.meta;
    meta.t0_utc_s = 1533226488.123456;
    meta.frame = Frame::sensor;
    meta.frame_stated = true;
    meta.gravity_included = false;
    meta.mount_auto = true;
    meta.mount_rpy_deg = {1.5, -2, 0.1};
    meta.mount_quat = {0.5, 0.5, -0.5, 0.5};
    meta.acc_sensor_pos_m = {1.3, 0, 0.2};
    meta.gnss_antenna_pos_m = {2, 0.1, 1.4};
    meta.gnss_latency_stated = true;
    meta.gnss_latency_s = 0.2;
    meta.speed_latency_s = -0.05;
    meta.speed_scale = 1.0175;
    meta.other = {{"licence", "MIT: see file"}, {"operator", "one\ntwo"}};
    const auto found = read_again(trip).meta;
    EXPECT_EQ(found.trip_id, meta.trip_id);
    EXPECT_EQ(found.vehicle_id, meta.vehicle_id);
    EXPECT_NEAR(*found.t0_utc_s, *meta.t0_utc_s, 5e-7); // to the microsecond
    EXPECT_EQ(found.frame, meta.frame);
    EXPECT_TRUE(found.frame_stated);
    EXPECT_FALSE(found.gravity_included);
    EXPECT_TRUE(found.mount_auto);
    EXPECT_EQ(found.mount_rpy_deg, meta.mount_rpy_deg);
    EXPECT_EQ(found.mount_quat, meta.mount_quat);
    EXPECT_EQ(found.acc_sensor_pos_m, meta.acc_sensor_pos_m);
    EXPECT_EQ(found.gnss_antenna_pos_m, meta.gnss_antenna_pos_m);
    EXPECT_TRUE(found.gnss_latency_stated);
    EXPECT_EQ(found.gnss_latency_s, meta.gnss_latency_s);
    EXPECT_EQ(found.speed_latency_s, meta.speed_latency_s);
    EXPECT_EQ(found.speed_scale, meta.speed_scale);
    EXPECT_EQ(found.other.at("licence"), "MIT: see file");
    EXPECT_EQ(found.other.at("operator"), "one two");
}

TEST(TripWriter, WritesTheSameBytesAgainOfAHeadWithStrayEndsOfLines) {
    auto trip = small_trip();
    trip.meta.other = {{"colour", "\rblue\n"}};
    const auto text = written_text(trip);
    EXPECT_THAT(text, HasSubstr("# colour: blue\n"));
    EXPECT_EQ(written_text(read_again(trip)), text);
}

TEST(TripWriter, LeavesATripUndatedThatIs) {
    auto trip = small_trip();
    trip.meta.t0_utc_s.reset();
    EXPECT_THAT(written_text(trip), HasSubstr("# t0_utc: unknown\n"));
    EXPECT_FALSE(read_again(trip).meta.t0_utc_s.has_value());
}

TEST(TripWriter, KeepsTheFixesOfACarThatStands) {
    auto trip = small_trip();
    auto fix = trip.fixes[0];
    for (int i = 1; i < 4; ++i) {
        fix.t_s += 1;
        trip.fixes.push_back(fix);
    }
    EXPECT_EQ(read_again(trip).fixes.size(), 4U);
    EXPECT_THAT(written_text(small_trip()), Not(HasSubstr("gnss_utc_s")));
}

TEST(TripWriter, RoundsToTheNearestDigit) {
    TripLog trip;
    trip.meta.t0_utc_s = 0;
    trip.speed = {{-1.0000004, 0.9999996, 1234567.25, 5e9}, {-0.00004F, 0.00006F, 99.99996F, -12}};
    EXPECT_THAT(written_text(trip),
                HasSubstr("t_s,speed_mps\n-1.000000,0.0000\n1.000000,0.0001\n"
                          "1234567.250000,100.0000\n5000000000.000000,-12.0000\n"));
}

TEST(TripWriter, WritesATripWithoutASample) {
    EXPECT_TRUE(read_again({}).rows.empty());
}

TEST(TripWriter, RefusesOtherSuffixes) {
    EXPECT_EQ(refusal_of([] { write_trip(small_trip(), "a.csv"); }),
              "a.csv: expected a name that ends in .trip.csv, .trip.csv.gz, .trip.csv.zst");
}

TEST(TripWriter, KeepsWhatTheRecorderSaysOfItsTrimming) {
    auto trip = small_trip();
    trip.meta.other["trimmed_m"] = "300";
    EXPECT_THAT(written_text(trip), HasSubstr("# trimmed_m: 300\n"));
    EXPECT_EQ(trimmed_before_m(read_again(trip).meta), 300);
    EXPECT_EQ(trimmed_before_m(read_again(small_trip()).meta), 0);
}

TEST(TripWriter, SaysWhyAFileCannotBeWritten) {
    EXPECT_THAT(refusal_of([] { write_trip(small_trip(), "/nowhere/a.trip.csv"); }),
                HasSubstr("/nowhere/a.trip.csv: cannot be written: No such file or directory"));
}
