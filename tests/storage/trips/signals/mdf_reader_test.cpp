#include "storage/trips/signals/mdf_reader.hpp"

#include "storage/trips/mappings/column_mapping_file.hpp"
#include "storage/trips/trip_reader.hpp"
#include "support/files/files.hpp"
#include "support/program/places.hpp"
#include "support/roads/walked_trips.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const TripNeeds everything{.acc = true, .gyro = true, .speed = true, .fixes = true};
const fs::path root{source_folder()};
const fs::path drive = root / "tests/data/mdf/drive.mf4";

const std::string channels = "acc_x_mps2 = {signal = \"AccX\"}\n"
                             "acc_y_mps2 = {signal = \"AccY\"}\n"
                             "acc_z_mps2 = {signal = \"IMU.AccZ\"}\n"
                             "speed_mps = {signal = \"Wheels.Speed\"}\n"
                             "lat_deg = {signal = \"Latitude\"}\n"
                             "lon_deg = {signal = \"Longitude\"}\n"
                             "gnss_speed_mps = {signal = \"GNSS.Speed\"}\n";

std::shared_ptr<const TripMapping> mapping(const std::string& of = channels) {
    return std::make_shared<const TripMapping>(
        parse_mapping("[mdf]\n[channels]\n" + of, "car.toml"));
}

TripLog read(const fs::path& file, const std::shared_ptr<const TripMapping>& of = mapping()) {
    return read_trip(find_trips(file, of).trips.at(0), everything);
}

std::string content_of(const fs::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

std::string refusal(const std::string& content, const std::string& of = channels) {
    const auto file = written(test_folder(), "a.mf4", content);
    return refusal_of([&] { read(file, mapping(of)); });
}

/// The drive of which the file was made.
TripLog original() {
    return read_trip({.file = root / "sample_data/gyor/gyor_q3_00.trip.csv", .member = {}},
                     everything);
}

TEST(Mdf, GivesTheDriveOfCompressedAndUnsortedGroups) {
    const auto trip = read(drive);
    const auto from = original();
    const auto first = std::ranges::lower_bound(from.acc.t_s, 40.0) - from.acc.t_s.begin();
    const auto count = static_cast<std::size_t>(std::ranges::lower_bound(from.acc.t_s, 46.0) -
                                                from.acc.t_s.begin() - first);
    ASSERT_THAT(trip.acc.t_s, SizeIs(count));
    for (std::size_t i = 0; i < count; ++i) {
        const auto j = static_cast<std::size_t>(first) + i;
        EXPECT_NEAR(trip.acc.t_s[i] - trip.acc.t_s[0],
                    from.acc.t_s[j] - from.acc.t_s[static_cast<std::size_t>(first)],
                    1e-6);
        EXPECT_EQ(std::isnan(trip.acc.x[i]), i % 100 == 50); // by its invalidation bit
        if (i % 100 != 50) {
            EXPECT_NEAR(trip.acc.x[i], from.acc.x[j], 0.00051);
        }
        EXPECT_NEAR(trip.acc.y[i], from.acc.y[j], 0.00051);
        EXPECT_NEAR(trip.acc.z[i], from.acc.z[j], 0.00051);
    }
    const auto fix = std::ranges::lower_bound(from.fixes, 40.0, {}, &GnssFix::t_s);
    ASSERT_THAT(trip.fixes, SizeIs(6));
    EXPECT_THAT(trip.speed.t_s, SizeIs(6));
    for (std::size_t i = 0; i < 6; ++i) {
        const auto& expected = *(fix + static_cast<std::ptrdiff_t>(i));
        EXPECT_NEAR(trip.fixes[i].at.lat_deg, expected.at.lat_deg, 1e-7);
        EXPECT_NEAR(trip.fixes[i].at.lon_deg, expected.at.lon_deg, 1e-12);
        EXPECT_NEAR(trip.fixes[i].speed_mps, expected.speed_mps, 1e-5);
        EXPECT_NEAR(trip.speed.speed_mps[i], expected.speed_mps, 1e-5); // of km/h
        EXPECT_NEAR(trip.speed.t_s[i] - trip.speed.t_s[0], static_cast<double>(i), 1e-6);
    }
    EXPECT_NEAR(*trip.meta.t0_utc_s, 1772352040, 0.02);
}

TEST(Mdf, ListsItsChannels) {
    EXPECT_THAT(mdf_channels(content_of(drive), "a.mf4"), Contains("Wheels.Speed [km/h]"));
    EXPECT_THAT(mdf_channels(content_of(drive), "a.mf4"), Contains("IMU.AccZ [m/s^2]"));
}

TEST(Mdf, SaysWhichChannelIsMeant) {
    const auto content = content_of(drive);
    EXPECT_THAT(refusal(content, "acc_z_mps2 = {signal = \"AcZ\"}\n"),
                HasSubstr("a.mf4: has no channel 'AcZ'; did you mean Acc?"));
    EXPECT_THAT(refusal(content, "speed_mps = {signal = \"Speed\"}\n"),
                HasSubstr("has 2 channels 'Speed', expected the name with that of its group: "
                          "'Wheels.Speed' or 'GNSS.Speed'"));
    EXPECT_THAT(refusal(content, "speed_mps = {signal = \"AccX\"}\n"),
                HasSubstr("the signal 'AccX' is in 'm/s^2', which is no unit of speed_mps"));
    EXPECT_THAT(refusal(content, "acc_z_mps2 = {signal = \"Acc\"}\n"),
                HasSubstr("channel 'Acc' is no number"));
}

TEST(Mdf, RefusesWhatIsDamagedOrOfAnotherVersion) {
    const auto content = content_of(drive);
    EXPECT_THAT(refusal("PK"), HasSubstr("begins with 'PK', expected an ASAM MDF file"));
    EXPECT_THAT(refusal("UnFinMF " + content.substr(8)), HasSubstr("was not finalised"));
    auto old = content;
    old[28] = 74; // 330
    old[29] = 1;
    EXPECT_THAT(refusal(old), HasSubstr("is MDF of version 3.30"));
    EXPECT_THAT(refusal(content.substr(0, content.size() - 100)), HasSubstr("may be truncated"));
    auto no_deflate = content;
    no_deflate[content.find("DT", content.find("##DZ")) + 30] ^= 0x55;
    EXPECT_THAT(refusal(no_deflate), HasSubstr("compressed data are damaged"));
}

const fs::path frames = root / "tests/data/mdf/frames.mf4";

const std::string signals = "acc_x_mps2 = {signal = \"ESP_Inertia.LongitudinalAcc\"}\n"
                            "acc_z_mps2 = {signal = \"VerticalAcc\"}\n"
                            "speed_mps = {signal = \"WheelBasedVehicleSpeed\"}\n" // 29 bits
                            "lat_deg = {signal = \"Latitude\"}\n"
                            "lon_deg = {signal = \"Longitude\"}\n";

/// Mapping of the frames of a bus: `format` is "can" or "mdf".
std::shared_ptr<const TripMapping> mapping_of_bus(const std::string& format,
                                                  const std::string& bus = "") {
    const auto dbc = (root / "tests/data/can/car.dbc").string();
    const auto of_bus = bus.empty() ? "" : fmt::format("bus = \"{}\"\n", bus);
    return std::make_shared<const TripMapping>(parse_mapping(
        fmt::format(
            "files = \"*\"\n[{}]\ndbc = \"{}\"\n{}[channels]\n{}", format, dbc, of_bus, signals),
        "car.toml"));
}

TEST(Mdf, GivesTheDriveOfRawFramesAsACandumpLogOfThemDoes) {
    const auto text = read(root / "tests/data/can/drive.log", mapping_of_bus("can"));
    const auto trip = read(frames, mapping_of_bus("mdf"));
    ASSERT_GT(text.acc.t_s.size(), 500U);
    EXPECT_EQ(trip.acc.z, text.acc.z);
    EXPECT_EQ(trip.speed.speed_mps, text.speed.speed_mps);
    ASSERT_THAT(trip.acc.t_s, SizeIs(text.acc.t_s.size()));
    EXPECT_NEAR(trip.acc.t_s.back(), text.acc.t_s.back(), 2e-6);
    ASSERT_THAT(trip.fixes, SizeIs(text.fixes.size()));
    EXPECT_EQ(trip.fixes.back().at.lat_deg, text.fixes.back().at.lat_deg);
    EXPECT_NEAR(*trip.meta.t0_utc_s, *text.meta.t0_utc_s, 2e-6);
    EXPECT_EQ(trip.rows.size(), text.rows.size());
    EXPECT_THAT(read(frames, mapping_of_bus("mdf", "1")).acc.t_s, SizeIs(text.acc.t_s.size()));
}

TEST(Mdf, SaysWhatRawFramesLack) {
    EXPECT_THAT(refusal(content_of(frames), "acc_z_mps2 = {signal = \"VerticalAcc\"}\n"),
                HasSubstr("has no channel 'VerticalAcc'; it holds frames of a CAN bus, expected a "
                          "DBC file that describes their signals: [mdf] dbc = \"car.dbc\""));
    EXPECT_THAT(refusal_of([] { read(drive, mapping_of_bus("mdf")); }),
                HasSubstr("has no channel CAN_DataFrame.ID, expected frames of a CAN bus"));
    EXPECT_THAT(refusal_of([] { read(frames, mapping_of_bus("mdf", "7")); }),
                AllOf(HasSubstr("frames, none of them with a mapped signal"),
                      HasSubstr("car.dbc describes")));
    EXPECT_THAT(refusal_of([] { parse_mapping("[mdf]\nbus = \"1\"\n[channels]\n", "car.toml"); }),
                HasSubstr("dbc"));
}

TEST(Mdf, LeavesOutFramesWhoseDataLieElsewhere) {
    auto content = content_of(frames);
    const auto values = content.find("##SD");
    content[values + 24] = 'x'; // the first length
    content[values + 27] = 'x';
    const auto file = written(test_folder(), "a.mf4", content);
    EXPECT_GT(read(file, mapping_of_bus("mdf")).acc.t_s.size(), 500U);
}

TEST(Mdf, EndsWhereLinksGoInACircle) {
    auto content = content_of(drive);
    const auto group = content.find("##DG");
    for (std::size_t i = 0; i < 8; ++i) { // its next group is itself
        content[group + 24 + i] = static_cast<char>((group >> (8 * i)) & 0xFF);
    }
    EXPECT_THAT(refusal(content), HasSubstr("goes in a circle"));
}

} // namespace
} // namespace macadam::testing
