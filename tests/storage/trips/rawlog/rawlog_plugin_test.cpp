// Rawlogs that MRPT itself wrote or reads are the oracle here.

#include "storage/files/decompress.hpp"
#include "storage/trips/rawlog/rawlog_reader.hpp"
#include "storage/trips/rawlog/rawlog_writer.hpp"

#include "storage/trips/log/trip_writer.hpp"
#include "storage/trips/trip_reader.hpp"
#include "support/files/compressed.hpp"
#include "support/files/files.hpp"
#include "support/program/places.hpp"
#include "support/roads/walked_trips.hpp"

#include <gmock/gmock.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cmath>

using namespace macadam;
using namespace macadam::testing;
using namespace mrpt::obs;
using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

namespace {

constexpr TripNeeds everything{.acc = true, .gyro = true, .speed = true, .fixes = true};
constexpr double t0_s = 1533226488;
const std::string rtk_file = source_folder() + "/tests/data/rawlog/test_rtk_path.rawlog";

/// Bytes in memory as a file would give them, a few at a time.
class Memory final : public ByteStream {
public:
    explicit Memory(std::string_view bytes) : rest_{bytes} {}
    std::size_t read(std::span<char> into) override {
        const auto count = rest_.copy(into.data(), std::min<std::size_t>(into.size(), 5000));
        rest_.remove_prefix(count);
        consumed_ += count;
        return count;
    }
    std::uint64_t consumed() const override { return consumed_; }

private:
    std::string_view rest_;
    std::uint64_t consumed_ = 0;
};

std::string hash_of(const TripSource& source) {
    return OpenTrip{source}.sha256();
}

TripLog read_bytes(std::string_view bytes, const TripNeeds& needs = everything) {
    return read_rawlog(std::make_unique<Memory>(bytes), "a.rawlog", needs);
}

std::string content_of(const std::filesystem::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

std::string unpacked(const std::filesystem::path& file) {
    const auto bytes = decompressed(file_bytes(file), file.string());
    std::string all;
    std::vector<char> block(1 << 16);
    while (const auto count = bytes->read(block)) {
        all.append(block.data(), count);
    }
    return all;
}

/// What MRPT makes of objects.
class Mrpt final : public mrpt::serialization::CArchive {
public:
    std::string bytes;
    std::string getArchiveDescription() const override { return "bytes"; }

protected:
    std::size_t read(void* /*to*/, std::size_t /*count*/) override { return 0; }
    std::size_t write(const void* from, std::size_t count) override {
        bytes.append(static_cast<const char*>(from), count);
        return count;
    }
};

template <typename... Objects>
std::string mrpt_bytes(const Objects&... objects) {
    Mrpt archive;
    (archive << ... << objects);
    return archive.bytes;
}

template <typename Observation>
Observation at(double t_s, const std::string& label) {
    Observation observation;
    observation.timestamp = mrpt::Clock::fromDouble(t0_s + t_s);
    observation.sensorLabel = label;
    return observation;
}

CObservationIMU imu_at(double t_s, double z_mps2) {
    auto imu = at<CObservationIMU>(t_s, "xsens");
    imu.set(IMU_X_ACC, 0.5);
    imu.set(IMU_Y_ACC, -0.25);
    imu.set(IMU_Z_ACC, z_mps2);
    imu.set(IMU_YAW_VEL, 0.3);
    imu.set(IMU_PITCH_VEL, 0.2);
    imu.set(IMU_ROLL_VEL, 0.1);
    return imu;
}

CObservationGPS gps_at(double t_s, double lat_deg, const std::string& label = "gps") {
    auto gps = at<CObservationGPS>(t_s, label);
    gnss::Message_NMEA_GGA gga;
    gga.fields.latitude_degrees = lat_deg;
    gga.fields.longitude_degrees = 11;
    gga.fields.fix_quality = 4;
    gga.fields.UTCTime.sec = t_s;
    gnss::Message_NMEA_RMC rmc;
    rmc.fields.validity_char = 'A';
    rmc.fields.speed_knots = 36; // 36 * 1852 m an hour = 18.52 m/s
    rmc.fields.direction_degrees = 90;
    gps.setMsg(gga);
    gps.setMsg(rmc);
    return gps;
}

CObservationOdometry pose_at(double t_s, double x_m, double y_m, double heading_rad) {
    auto odometry = at<CObservationOdometry>(t_s, "odo");
    odometry.odometry = {x_m, y_m, heading_rad};
    return odometry;
}

/// One of everything that a trip can hold.
TripLog small_trip() {
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
    TripLog trip;
    auto& meta = trip.meta;
    meta.trip_id = "a-1";
    meta.vehicle_id = "rav4-7";
    meta.t0_utc_s = t0_s + 0.225;
    meta.frame = Frame::sensor;
    meta.frame_stated = true;
    meta.mount_rpy_deg = {1.5, -2, 0.1};
    meta.gnss_latency_stated = true;
    meta.gnss_latency_s = 0.2;
    meta.speed_scale = 1.0175;
    meta.other = {{"licence", "MIT: see file"}};
    trip.acc = {{0, 0.01, 0.02}, {0.1F, none, -0.25F}, {none, none, none}, {9.81F, 9.5F, 10}};
    trip.gyro = {{0.01, 0.03}, {0.001F, 1}, {-0.002F, 2}, {0, 3}};
    trip.speed = {{0.005, 0.02}, {7.9743F, -0.5F}};
    trip.fixes = {{0.02, {37.7209977123456, -122.4723053}, 7.823F, 2.1356F, 1.5F},
                  {1.02, {37.7209977123456, -122.4723053}, 7.823F, 2.1356F, none}, // it stands
                  {2.02, {37.8, -122}, none, none, 3},
                  {3.02, {nowhere, nowhere}, 3, none, none}};
    return trip;
}

std::string small_rawlog() {
    const auto file = test_folder() / "small.rawlog";
    write_rawlog(small_trip(), file);
    return unpacked(file);
}

bool same(double a, double b) {
    return a == b || (std::isnan(a) && std::isnan(b));
}

void expect_same(const std::vector<float>& found, const std::vector<float>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_TRUE(same(found[i], expected[i])) << i << ": " << found[i];
    }
}

void expect_times(const std::vector<double>& found, const std::vector<double>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i], expected[i], 0.51e-7); // half of MRPT's 100 ns
    }
}

void expect_same(const TripLog& found, const TripLog& expected) {
    expect_times(found.acc.t_s, expected.acc.t_s);
    expect_same(found.acc.x, expected.acc.x);
    expect_same(found.acc.y, expected.acc.y);
    expect_same(found.acc.z, expected.acc.z);
    expect_times(found.gyro.t_s, expected.gyro.t_s);
    expect_same(found.gyro.x, expected.gyro.x);
    expect_same(found.gyro.y, expected.gyro.y);
    expect_same(found.gyro.z, expected.gyro.z);
    expect_times(found.speed.t_s, expected.speed.t_s);
    expect_same(found.speed.speed_mps, expected.speed.speed_mps);
    ASSERT_EQ(found.fixes.size(), expected.fixes.size());
    for (std::size_t i = 0; i < found.fixes.size(); ++i) {
        const auto& a = found.fixes[i];
        const auto& b = expected.fixes[i];
        expect_times({a.t_s}, {b.t_s});
        EXPECT_TRUE(same(a.at.lat_deg, b.at.lat_deg) && same(a.at.lon_deg, b.at.lon_deg)) << i;
        expect_same({a.speed_mps, a.course_deg, a.accuracy_m},
                    {b.speed_mps, b.course_deg, b.accuracy_m});
    }
}

std::size_t rows_with(const TripLog& trip, RowReason reason) {
    return static_cast<std::size_t>(
        std::ranges::count(trip.rows, static_cast<std::uint8_t>(reason)));
}

} // namespace

TEST(Rawlog, GivesBackATripAsItWas) {
    const auto trip = small_trip();
    const auto found = read_bytes(small_rawlog());
    expect_same(found, trip);
    EXPECT_EQ(found.meta.trip_id, trip.meta.trip_id);
    EXPECT_EQ(found.meta.vehicle_id, trip.meta.vehicle_id);
    EXPECT_EQ(found.meta.t0_utc_s, trip.meta.t0_utc_s);
    EXPECT_EQ(found.meta.frame, trip.meta.frame);
    EXPECT_EQ(found.meta.mount_rpy_deg, trip.meta.mount_rpy_deg);
    EXPECT_TRUE(found.meta.gnss_latency_stated);
    EXPECT_EQ(found.meta.gnss_latency_s, trip.meta.gnss_latency_s);
    EXPECT_EQ(found.meta.speed_scale, trip.meta.speed_scale);
    EXPECT_EQ(found.meta.other, trip.meta.other);
}

TEST(Rawlog, GivesBackTwoRecordedTrips) {
    const std::string samples = source_folder() + "/sample_data/";
    for (const auto* const name :
         {"comma2k19/comma2k19_rav4.trip.csv", "gyor/gyor_q3_00.trip.csv"}) {
        SCOPED_TRACE(name);
        const auto trip = read_trip({samples + name, ""}, everything);
        const auto file = test_folder() / "a.rawlog";
        const auto objects = write_rawlog(trip, file, 1);
        const auto found = read_trip({file, ""}, everything);
        expect_same(found, trip);
        EXPECT_THAT(found.rows, SizeIs(objects));
        EXPECT_EQ(rows_with(found, RowReason::unused_channel), 1U); // the head
    }
}

TEST(Rawlog, GivesBackATripWithoutADate) {
    auto trip = small_trip();
    trip.meta.t0_utc_s.reset();
    const auto file = test_folder() / "a.rawlog";
    write_rawlog(trip, file);
    const auto found = read_trip({file, ""}, everything);
    EXPECT_FALSE(found.meta.t0_utc_s.has_value());
    expect_same(found, trip);
}

TEST(Rawlog, IsReadByMrpt) {
    const auto file = test_folder() / "a.rawlog";
    write_rawlog(small_trip(), file);
    CRawlog rawlog;
    ASSERT_TRUE(rawlog.loadFromRawLogFile(file.string()));
    EXPECT_THAT(rawlog.getCommentText(), StartsWith("# macadam-trip 1\n# trip_id: a-1\n"));
    ASSERT_EQ(rawlog.size(), 10U); // 4 IMU, 2 odometry, 4 fixes
    const auto imu = std::dynamic_pointer_cast<CObservationIMU>(rawlog.getAsObservation(2));
    ASSERT_TRUE(imu);
    EXPECT_NEAR(mrpt::Clock::toDouble(imu->timestamp), t0_s + 0.235, 1e-6);
    EXPECT_FALSE(imu->has(IMU_X_ACC));
    EXPECT_EQ(imu->get(IMU_Z_ACC), 9.5);
    EXPECT_EQ(imu->get(IMU_ROLL_VEL), 0.001F);
    EXPECT_EQ(imu->get(IMU_YAW_VEL), 0);
    const auto odometry =
        std::dynamic_pointer_cast<CObservationOdometry>(rawlog.getAsObservation(1));
    ASSERT_TRUE(odometry);
    EXPECT_EQ(odometry->velocityLocal.vx, 7.9743F);
    const auto gps = std::dynamic_pointer_cast<CObservationGPS>(rawlog.getAsObservation(5));
    ASSERT_TRUE(gps);
    const auto gga = gps->getMsgByClass<gnss::Message_NMEA_GGA>().fields;
    const auto rmc = gps->getMsgByClass<gnss::Message_NMEA_RMC>().fields;
    const double lat_deg = gga.latitude_degrees; // not bound where it lies: the struct is packed
    const double speed_knots = rmc.speed_knots;
    EXPECT_EQ(lat_deg, 37.7209977123456);
    EXPECT_NEAR(speed_knots, 7.823 * 3600 / 1852, 1e-5); // a float's digits
}

TEST(Rawlog, WritesTheSameBytesEachTime) {
    const auto folder = test_folder();
    write_rawlog(small_trip(), folder / "a.rawlog");
    write_rawlog(small_trip(), folder / "b.rawlog");
    EXPECT_EQ(content_of(folder / "a.rawlog"), content_of(folder / "b.rawlog"));
}

TEST(Rawlog, ReadsWhatMrptWroteIn2008) {
    const auto trip = read_trip({rtk_file, ""}, needs_of_match());
    EXPECT_THAT(trip.rows, SizeIs(692)); // as MRPT counts them
    // Of three receivers that of which there is most is taken: 307 fixes, one each second or less.
    EXPECT_EQ(rows_with(trip, RowReason::unused_channel), 692U - 307U);
    EXPECT_EQ(trip.fixes.size() + rows_with(trip, RowReason::repeated_fix), 307U);
    EXPECT_NEAR(*trip.meta.t0_utc_s, 1226225355, 1); // 2008-11-09, and 10:09:15 as its GGA says
    for (const auto& fix : trip.fixes) {             // the origin that the file's comment gives
        EXPECT_NEAR(fix.at.lat_deg, 36.714459075, 0.01);
        EXPECT_NEAR(fix.at.lon_deg, -4.478958828, 0.01);
    }
}

TEST(Rawlog, HashesTheDecompressedContent) {
    const auto folder = test_folder();
    const auto plain = written(folder, "plain.rawlog", unpacked(rtk_file));
    EXPECT_EQ(read_trip({plain, ""}, everything).sha256, hash_of({rtk_file, ""}));
    EXPECT_EQ(hash_of({plain, ""}), hash_of({rtk_file, ""}));
}

TEST(Rawlog, TakesEachFieldForWhatMrptMeans) {
    const auto trip = read_bytes(mrpt_bytes(imu_at(0, 9.81), gps_at(0.5, 48)));
    EXPECT_EQ(trip.meta.t0_utc_s, t0_s);
    EXPECT_EQ(trip.meta.frame, Frame::flu);
    EXPECT_THAT(trip.acc.x, ElementsAre(0.5F));
    EXPECT_THAT(trip.acc.y, ElementsAre(-0.25F));
    EXPECT_THAT(trip.acc.z, ElementsAre(9.81F));
    EXPECT_THAT(trip.gyro.x, ElementsAre(0.1F)); // roll
    EXPECT_THAT(trip.gyro.y, ElementsAre(0.2F)); // pitch
    EXPECT_THAT(trip.gyro.z, ElementsAre(0.3F)); // yaw
    ASSERT_THAT(trip.fixes, SizeIs(1));
    EXPECT_EQ(trip.fixes[0].t_s, 0.5);
    EXPECT_EQ(trip.fixes[0].at, (GeoPoint{48, 11}));
    EXPECT_FLOAT_EQ(trip.fixes[0].speed_mps, 18.52F);
    EXPECT_EQ(trip.fixes[0].course_deg, 90);
}

TEST(Rawlog, TellsTheMountingFromThePoseOfTheImu) {
    auto imu = imu_at(0, 9.81);
    imu.sensorPose.setFromValues(1, 2, 3, 0.3, -0.2, 0.1); // yaw, pitch, roll
    const auto meta = read_bytes(mrpt_bytes(imu)).meta;
    EXPECT_EQ(meta.frame, Frame::sensor);
    ASSERT_TRUE(meta.mount_rpy_deg);
    EXPECT_NEAR((*meta.mount_rpy_deg)[0], 0.1 * 180 / M_PI, 1e-9);
    EXPECT_NEAR((*meta.mount_rpy_deg)[1], -0.2 * 180 / M_PI, 1e-9);
    EXPECT_NEAR((*meta.mount_rpy_deg)[2], 0.3 * 180 / M_PI, 1e-9);
}

TEST(Rawlog, MakesSpeedsOfPoses) {
    // 2 m north in half a second, then 1 m back, then a hole of 3 s.
    const auto trip = read_bytes(mrpt_bytes(pose_at(0, 5, 5, M_PI / 2),
                                            pose_at(0.5, 5, 7, M_PI / 2),
                                            pose_at(1, 5, 6, M_PI / 2),
                                            pose_at(4, 5, 9, M_PI / 2)));
    EXPECT_THAT(trip.speed.t_s, ElementsAre(0.25, 0.75)); // each in the middle
    EXPECT_THAT(trip.speed.speed_mps, ElementsAre(4.0F, -2.0F));
    EXPECT_EQ(rows_with(trip, RowReason::no_sample), 2U);
}

TEST(Rawlog, TakesAReceiverWithoutAFixForNone) {
    auto lost = gps_at(0, 48);
    lost.getMsgByClass<gnss::Message_NMEA_GGA>().fields.fix_quality = 0;
    EXPECT_EQ(rows_with(read_bytes(mrpt_bytes(lost)), RowReason::out_of_range), 1U);
}

TEST(Rawlog, TakesTheSensorOfWhichThereIsMost) {
    const auto trip = read_bytes(
        mrpt_bytes(gps_at(0, 47, "rear"), gps_at(0.1, 48, "front"), gps_at(1.1, 48.1, "front")));
    ASSERT_THAT(trip.fixes, SizeIs(2));
    EXPECT_EQ(trip.fixes[0].at.lat_deg, 48);
    EXPECT_EQ(rows_with(trip, RowReason::unused_channel), 1U);
}

TEST(Rawlog, CountsWhatItDoesNotUse) {
    CObservation2DRangeScan scan;
    scan.resizeScan(500);
    scan.timestamp = mrpt::Clock::fromDouble(t0_s);
    CActionRobotMovement2D action;
    CActionCollection actions;
    actions.insert(action);
    actions.insert(action);
    auto novatel = at<CObservationGPS>(0.5, "gps");
    novatel.setMsg(gnss::Message_NV_OEM6_BESTPOS{});
    for (const auto& bytes : {mrpt_bytes(scan, imu_at(0, 9), actions, novatel, imu_at(1, 10)),
                              mrpt_bytes(imu_at(0, 9), novatel, scan, imu_at(1, 10), actions)}) {
        const auto trip = read_bytes(bytes);
        EXPECT_THAT(trip.acc.z, ElementsAre(9, 10));
        EXPECT_THAT(trip.rows, SizeIs(5));
        EXPECT_EQ(rows_with(trip, RowReason::unused_channel), 3U);
    }
}

TEST(Rawlog, ReadsObservationsInFrames) {
    auto scan = std::make_shared<CObservation2DRangeScan>();
    scan->resizeScan(100);
    const auto imu = std::make_shared<CObservationIMU>(imu_at(0, 9));
    CSensoryFrame scan_first;
    scan_first.insert(scan);
    scan_first.insert(imu);
    CSensoryFrame scan_last;
    scan_last.insert(imu);
    scan_last.insert(scan);
    for (const auto& frame : {scan_first, scan_last}) {
        EXPECT_THAT(read_bytes(mrpt_bytes(frame)).acc.z, ElementsAre(9));
        const auto trip = read_bytes(mrpt_bytes(frame, imu_at(1, 10), frame));
        EXPECT_THAT(trip.rows, SizeIs(5));
        EXPECT_EQ(rows_with(trip, RowReason::unused_channel), 2U); // the scans
    }
    EXPECT_TRUE(read_bytes(mrpt_bytes(CSensoryFrame{})).rows.empty());
}

TEST(Rawlog, AsksForTheSensorsThatAreNeeded) {
    EXPECT_THAT(refusal_of([] {
                    read_trip({rtk_file, ""}, needs_of_import());
                }),
                EndsWith("test_rtk_path.rawlog: contains 1 CObservationComment, 691 "
                         "CObservationGPS, expected also messages for vertical acceleration"));
}

TEST(Rawlog, ReadsFixesBesideWhatReceiversOfTopconSaid) {
    // MRPT 2.5 would write that into memory it has freed.
    const std::string file = source_folder() + "/tests/fuzz/findings/rawlog/topcon.rawlog";
    const auto trip = read_trip({file, ""}, everything);
    ASSERT_THAT(trip.fixes, SizeIs(5)); // of versions 5 to 9
    EXPECT_NEAR(trip.fixes.back().at.lat_deg, 48.0009, 1e-9);
    EXPECT_FLOAT_EQ(trip.fixes.back().speed_mps, 18.52F);
}

TEST(Rawlog, IsFoundInFoldersAndArchives) {
    const auto folder = test_folder();
    const auto bytes = content_of(rtk_file);
    written(folder, "in/a.rawlog", bytes);
    written(folder, "b.zip", archive_of("zip", {{"c/d.rawlog", bytes}}));
    for (const auto& place : {folder / "in", folder / "b.zip"}) {
        const auto search = find_trips(place);
        ASSERT_THAT(search.trips, SizeIs(1));
        EXPECT_THAT(read_trip(search.trips[0], everything).rows, SizeIs(692));
    }
}

// ------------------------------------------------------------------------------- broken files

TEST(Rawlog, RefusesWhatIsOfAnotherKind) {
    const std::vector<std::pair<std::string, std::string>> kinds{
        {"", "is empty"},
        {"lat,lon\n1,2\n", "is text ('lat,lon')"},
        {"# macadam-trip 1\nt_s\n", "is a trip log (*.trip.csv)"},
        {"\x89PNG\r\n\x1a\n", "is a picture (PNG)"},
        {std::string{"\0\0\0\x0d\x0a\x09OSMHeader\x18\x7c", 17},
         "is an OpenStreetMap file (.osm.pbf)"},
        {"PK\x03\x04 and more", "is a zip archive"},
        {std::string(300, '\0'), "object 1 at byte 0: '\\x00\\x00"}};
    for (const auto& [bytes, words] : kinds) {
        EXPECT_THAT(refusal_of([&] { read_bytes(bytes); }),
                    AllOf(StartsWith("a.rawlog: "), HasSubstr(words), HasSubstr("expected ")));
    }
}

TEST(Rawlog, SaysWhereItIsCutOff) {
    const auto one = mrpt_bytes(imu_at(0, 9));
    const auto bytes = one + one;
    EXPECT_EQ(refusal_of([&] { read_bytes(std::string_view{bytes}.substr(0, one.size() + 200)); }),
              "a.rawlog: object 2 at byte 444: the file ends within CObservationIMU");
}

TEST(Rawlog, IsRefusedWhereverAnUncompressedOneIsCut) {
    for (const auto& bytes : {unpacked(rtk_file).substr(0, 20'000), small_rawlog()}) {
        std::size_t whole_objects = 0;
        for (std::size_t size = 0; size < bytes.size(); size += 100) {
            const auto cut = std::string_view{bytes}.substr(0, size);
            const bool refused = !refusal_of([&] { read_bytes(cut); }).empty();
            // An object may end just there; then nothing tells that others followed.
            whole_objects += refused ? 0 : 1;
            EXPECT_TRUE(refused || cut.back() == '\x88') << size;
        }
        EXPECT_LE(whole_objects, bytes.size() / 100 / 50);
    }
}

TEST(Rawlog, IsRefusedWhereverACompressedOneIsCut) {
    const auto bytes = content_of(rtk_file);
    const auto folder = test_folder();
    ASSERT_GT(bytes.size(), 1600U);
    for (std::size_t size = 10; size < bytes.size(); size += size < 100 ? 30 : 1500) {
        const auto file = written(folder, "cut.rawlog", bytes.substr(0, size));
        EXPECT_THAT(refusal_of([&] {
                        read_trip({file, ""}, everything);
                    }),
                    HasSubstr("the gzip data is truncated"))
            << size;
    }
}

TEST(Rawlog, NeitherCrashesNorLosesARowWhateverByteIsTurned) {
    const auto bytes = small_rawlog();
    std::size_t refused = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        auto damaged = bytes;
        damaged[i] = static_cast<char>(damaged[i] ^ (i % 2 == 0 ? 0xff : 0x10));
        refused += refusal_of([&] {
                       const auto trip = read_bytes(damaged);
                       EXPECT_GE(trip.rows.size(), 1U);
                   }).empty()
                       ? 0
                       : 1;
    }
    EXPECT_GT(refused, bytes.size() / 10); // names, lengths, flags; the rest is numbers
}

TEST(Rawlog, RefusesLengthsBeyondTheFile) {
    auto bytes = mrpt_bytes(imu_at(0, 9));
    const auto label = bytes.rfind("xsens") - 4;
    for (const auto& size : {std::string(4, '\xff'), std::string{"\0\0\0\x01", 4}}) {
        bytes.replace(label, 4, size);
        EXPECT_THAT(refusal_of([&] { read_bytes(bytes); }),
                    AllOf(StartsWith("a.rawlog: object 1 at byte 0: "),
                          ::testing::AnyOf(HasSubstr("a text of"), HasSubstr("ends within"))));
    }
}

TEST(Rawlog, RefusesVersionsItDoesNotKnow) {
    auto bytes = mrpt_bytes(imu_at(0, 9));
    bytes[bytes.find("CObservationIMU") + 15] = 9;
    EXPECT_EQ(refusal_of([&] { read_bytes(bytes); }),
              "a.rawlog: object 1 at byte 0: CObservationIMU of version 9, expected a version up "
              "to 4");
}
