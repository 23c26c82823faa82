#include "storage/trips/signals/can_reader.hpp"

#include "storage/trips/mappings/column_mapping_file.hpp"
#include "storage/trips/mappings/dbc.hpp"
#include "storage/trips/signals/can_frames.hpp"
#include "storage/trips/source/trip_contents.hpp"
#include "storage/trips/trip_reader.hpp"
#include "support/files/files.hpp"
#include "support/program/places.hpp"
#include "support/roads/walked_trips.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const TripNeeds everything{.acc = true, .gyro = true, .speed = true, .fixes = true};
const fs::path root{source_folder()};
const fs::path logs = root / "tests/data/can";

const std::string channels = "[channels]\n"
                             "acc_x_mps2 = {signal = \"ESP_Inertia.LongitudinalAcc\"}\n"
                             "acc_y_mps2 = {signal = \"LateralAcc\"}\n"
                             "acc_z_mps2 = {signal = \"VerticalAcc\"}\n"
                             "gyro_z_radps = {signal = \"YawRate\"}\n"
                             "speed_mps = {signal = \"WheelBasedVehicleSpeed\"}\n"
                             "wheel_fl_mps = {signal = \"FrontLeft\"}\n"
                             "lat_deg = {signal = \"Latitude\"}\n"
                             "lon_deg = {signal = \"Longitude\"}\n"
                             "gnss_speed_mps = {signal = \"Position.Speed\"}\n"
                             "course_deg = {signal = \"Course\"}\n";

/// A mapping with the DBC file of the folder of specimens.
std::shared_ptr<const TripMapping> mapping(const std::string& more = channels) {
    const auto toml =
        fmt::format("files = \"*\"\n[can]\ndbc = \"{}\"\n{}", (logs / "car.dbc").string(), more);
    return std::make_shared<const TripMapping>(parse_mapping(toml, "car.toml"));
}

TripLog read(const fs::path& log, const std::shared_ptr<const TripMapping>& of = mapping()) {
    return read_trip(find_trips(log, of).trips.at(0), everything);
}

struct Driven {
    TripLog trip;
    std::vector<std::size_t> acc; ///< indices in the 8 s of the CAN logs
};

/// The drive of which the logs were made.
Driven original() {
    Driven driven{read_trip({.file = root / "sample_data/gyor/gyor_q3_00.trip.csv", .member = {}},
                            everything),
                  {}};
    for (std::size_t i = 0; i < driven.trip.acc.t_s.size(); ++i) {
        if (driven.trip.acc.t_s[i] >= 40 && driven.trip.acc.t_s[i] < 48) {
            driven.acc.push_back(i);
        }
    }
    return driven;
}

void expect_drive(const TripLog& trip, double time_accuracy_s) {
    const auto [from, acc] = original();
    ASSERT_THAT(trip.acc.t_s, SizeIs(acc.size()));
    const double begin_s = from.acc.t_s[acc.front()];
    for (std::size_t i = 0; i < acc.size(); ++i) {
        const auto j = acc[i];
        EXPECT_NEAR(trip.acc.t_s[i] - trip.acc.t_s[0], from.acc.t_s[j] - begin_s, time_accuracy_s);
        EXPECT_NEAR(trip.acc.x[i], from.acc.x[j], 0.003); // half a bit of 0.0005 g
        EXPECT_NEAR(trip.acc.y[i], from.acc.y[j], 0.003);
        EXPECT_NEAR(trip.acc.z[i], from.acc.z[j], 0.003);
    }
    EXPECT_THAT(trip.gyro.t_s, SizeIs(acc.size()));
    EXPECT_TRUE(std::isnan(trip.gyro.x[0]));
    const auto fixes = std::ranges::count_if(
        from.fixes, [](const GnssFix& fix) { return fix.t_s >= 40 && fix.t_s < 48; });
    ASSERT_THAT(trip.fixes, SizeIs(static_cast<std::size_t>(fixes)));
    EXPECT_TRUE(std::isnan(trip.fixes[0].at.lat_deg)); // its longitude comes later
    EXPECT_NEAR(trip.fixes[3].speed_mps, 15, 10);
    EXPECT_GT(trip.speed.t_s.size(), 70U);
    EXPECT_NEAR(trip.speed.speed_mps[0], trip.fixes[0].speed_mps, 3);
}

TEST(CanLog, GivesTheDriveOfACandumpLog) {
    const auto trip = read(logs / "drive.log");
    expect_drive(trip, 2e-6);
    EXPECT_NEAR(*trip.meta.t0_utc_s, 1772352040, 0.01);
    EXPECT_EQ(trip.meta.trip_id, "drive");
    const auto count = [&](RowReason reason) {
        return std::ranges::count(trip.rows, code(reason));
    };
    EXPECT_GT(count(RowReason::unused_channel), 100); // 7DF, 200, and wheels beside the speed
    EXPECT_EQ(count(RowReason::bad_number), 0);
}

TEST(CanLog, GivesTheDriveOfVectorAscOfTwoPrograms) {
    expect_drive(read(logs / "drive.asc"), 2e-6);
    expect_drive(read(logs / "log2asc.asc"), 2e-4); // four decimals
}

TEST(CanLog, DatesAnAscFileOnlyWithTheOffsetOfItsLocalTime) {
    EXPECT_EQ(read(logs / "drive.asc").meta.t0_utc_s, std::nullopt);
    const auto trip = read(logs / "drive.asc", mapping("[time]\nutc_offset_h = 1\n" + channels));
    EXPECT_NEAR(*trip.meta.t0_utc_s, 1772352040 - 3600, 1);
}

TEST(CanLog, ReadsFloatsOfCanFd) {
    const auto of = mapping("[channels]\nacc_z_mps2 = {signal = \"AccZ\"}\n");
    for (const auto* const name : {"drive.log", "drive.asc", "log2asc.asc"}) {
        const auto trip = read(logs / name, of);
        const auto [from, acc] = original();
        ASSERT_THAT(trip.acc.z, SizeIs((acc.size() + 49) / 50));
        EXPECT_FLOAT_EQ(trip.acc.z[1], from.acc.z[acc[50]]);
    }
}

// ------------------------------------------------------------------------------------- frames

std::vector<CanFrames::Line> lines_of(const std::string& text,
                                      std::vector<CanFrame>* all = nullptr) {
    const auto contents = std::make_shared<const TripContents>(TripContents{{{"", text, ""}}});
    CanFrames frames{{bytes_of(contents, ""), "a.log"}, std::nullopt};
    std::vector<CanFrames::Line> lines;
    while (const auto line = frames.next()) {
        lines.push_back(*line);
        if (all != nullptr) {
            all->push_back(frames.frame());
        }
    }
    return lines;
}

constexpr auto frame = CanFrames::Line::frame;
constexpr auto other = CanFrames::Line::other;
constexpr auto damaged = CanFrames::Line::damaged;

TEST(CanFrames, ReadsTheFormsOfCandump) {
    std::vector<CanFrame> all;
    EXPECT_THAT(lines_of("(1.5) can0 123#\n"
                         "(1.5) can0 123#0102.03 T\n"
                         "(1.5)  can1  12345678   [2]  0A 0B\n"
                         "(1.5) vcan0 00000123##1FF\n"
                         "(1.5) can0 123#R8\n"
                         "(1.5) can0 20000004#0000\n",
                         &all),
                ElementsAre(frame, frame, frame, frame, other, other));
    EXPECT_EQ(all[0].size, 0);
    EXPECT_EQ(all[1].size, 3);
    EXPECT_EQ(all[2].id, 0x12345678U);
    EXPECT_EQ(all[2].bus, "can1");
    EXPECT_EQ(all[2].bytes[1], 0x0B);
    EXPECT_TRUE(all[3].is_extended);
    EXPECT_EQ(all[3].bytes[0], 0xFF);
}

TEST(CanFrames, CountsDamagedFrames) {
    EXPECT_THAT(
        lines_of("(1.5) can0 123#0\n(x) can0 123#00\n(1.5) can0 FFF#00\n(1.5) can0 1#0G\n"
                 "1.5 can0 123#00\n(1.5) can0 123 [3] 00 01\n(1.5\n(1.5) can0 123#" +
                 std::string(130, '0') + "\n# remark\n"),
        ElementsAre(damaged, damaged, damaged, damaged, damaged, damaged, damaged, damaged, other));
}

TEST(CanFrames, ReadsRelativeTimesAndDecimalNumbersOfAsc) {
    std::vector<CanFrame> all;
    const auto lines = lines_of("date Die Mrz 3 10:00:00.000 2026\nbase dec timestamps relative\n"
                                "0.5 1 291 Rx d 2 255 16\n0.5 1 291x Rx d 1 1\n"
                                "0.5 1 291 Rx r\n0.5 1 ErrorFrame\n0.5 1 291 Rx d 1 256\n"
                                "0.5 CANFD 5 Tx ErrorFrame Not Acknowledge error\n",
                                &all);
    EXPECT_THAT(lines, ElementsAre(other, other, frame, frame, other, other, damaged, other));
    EXPECT_EQ(all[2].id, 291U);
    EXPECT_EQ(all[2].bytes[0], 255);
    EXPECT_DOUBLE_EQ(all[3].t_s, 1);
}

// ---------------------------------------------------------------------------------------- DBC

Dbc dbc(const std::string& text) {
    return read_dbc(written(test_folder(), "a.dbc", text));
}

std::string dbc_refusal(const std::string& text) {
    return refusal_of([&] { dbc(text); });
}

std::optional<double> value(const std::string& signal, const std::vector<std::uint8_t>& data) {
    const auto file = dbc("BO_ 1 M: 8 X\n SG_ " + signal + "\n");
    return signal_value(file.messages[0], file.messages[0].signals[0], data);
}

TEST(Dbc, ExtractsBothByteOrdersAndSigns) {
    EXPECT_EQ(value("S : 4|12@1+ (1,0) [0|0] \"\" X", {0x10, 0x32}), 0x321);
    EXPECT_EQ(value("S : 4|12@1- (1,0) [0|0] \"\" X", {0xF0, 0xFF}), -1);
    EXPECT_EQ(value("S : 3|12@0+ (1,0) [0|0] \"\" X", {0xA1, 0x23}), 0x123);
    EXPECT_EQ(value("S : 7|16@0- (0.5,10) [0|0] \"\" X", {0xFF, 0xFE}), 9);
    EXPECT_EQ(value("S : 0|64@1- (1,0) [0|0] \"\" X", std::vector<std::uint8_t>(8, 0xFF)), -1);
    EXPECT_EQ(value("S : 8|8@1+ (1,0) [0|0] \"\" X", {1}), std::nullopt); // too short
}

TEST(Dbc, FollowsNestedMultiplexors) {
    const auto file = dbc("BO_ 1 M: 8 X\n SG_ A M : 0|8@1+ (1,0) [0|0] \"\" X\n"
                          " SG_ B m1M : 8|8@1+ (1,0) [0|0] \"\" X\n"
                          " SG_ C m2 : 16|8@1+ (1,0) [0|0] \"\" X\n"
                          "SG_MUL_VAL_ 1 B A 1-3;\nSG_MUL_VAL_ 1 C B 2-2, 5-7;\n");
    const auto& message = file.messages[0];
    const auto c = [&](std::uint8_t a, std::uint8_t b) {
        return signal_value(message, *message.signal("C"), std::vector<std::uint8_t>{a, b, 42});
    };
    EXPECT_EQ(c(1, 2), 42);
    EXPECT_EQ(c(3, 6), 42);
    EXPECT_EQ(c(4, 2), std::nullopt);
    EXPECT_EQ(c(1, 3), std::nullopt);
}

TEST(Dbc, EndsWhereMultiplexorsGoInACircle) {
    const auto file = dbc("BO_ 1 M: 8 X\n SG_ A m1M : 0|8@1+ (1,0) [0|0] \"\" X\n"
                          " SG_ B m1M : 8|8@1+ (1,0) [0|0] \"\" X\n"
                          "SG_MUL_VAL_ 1 A B 0-255;\nSG_MUL_VAL_ 1 B A 0-255;\n");
    EXPECT_EQ(signal_value(
                  file.messages[0], file.messages[0].signals[0], std::vector<std::uint8_t>{1, 1}),
              std::nullopt);
}

TEST(Dbc, SaysWhatIsWrong) {
    EXPECT_THAT(dbc_refusal("VERSION \"\"\n"), HasSubstr("describes no signal"));
    EXPECT_THAT(dbc_refusal(" SG_ A : 0|8@1+ (1,0) [0|0] \"\" X\n"),
                HasSubstr("a.dbc:1: 'A : 0|8@1+ (1,0) [0|0] \"\" X', expected a message"));
    EXPECT_THAT(
        dbc_refusal("BO_ 1 M: 8 X\n SG_ A : 0|65@1+ (1,0) [0|0] \"\" X\n"),
        HasSubstr("a.dbc:2: '65@1+ (1,0) [0|0] \"\" X', expected a whole number from 1 to 64"));
    EXPECT_THAT(dbc_refusal("BO_ 1 M: 8 X\n SG_ A : 0|8@1+ (x,0) [0|0] \"\" X\n"),
                HasSubstr("'x,0) [0|0] \"\" X', expected a number"));
    EXPECT_THAT(
        dbc_refusal("BO_ 1 M: 8 X\n SG_ A : 0|16@1- (1,0) [0|0] \"\" X\nSIG_VALTYPE_ 1 A : 1;\n"),
        HasSubstr("signal 'A' is a float of 16 bits, expected 32"));
}

// ------------------------------------------------------------------------------------ mapping

std::string mapping_refusal(const std::string& toml) {
    return refusal_of([&] { mapping("[channels]\n" + toml); });
}

TEST(CanMapping, SaysWhichSignalIsMeant) {
    EXPECT_THAT(mapping_refusal("acc_z_mps2 = {signal = \"VerticalAc\"}"),
                HasSubstr("expected a signal of the DBC file; did you mean VerticalAcc?"));
    EXPECT_THAT(mapping_refusal("acc_z_mps2 = {column = \"VerticalAcc\"}"),
                HasSubstr("unknown key 'acc_z_mps2.column', expected signal"));
    EXPECT_THAT(mapping_refusal("speed_mps = {signal = \"VerticalAcc\"}"),
                HasSubstr("the DBC file says 'g', which is no unit of speed_mps"));
    EXPECT_THAT(refusal_of([] { parse_mapping("[can]\n[channels]\n", "a.toml"); }),
                HasSubstr("dbc"));
}

TEST(CanMapping, TakesOneBusOnly) {
    const auto of = mapping("bus = \"can1\"\n" + channels);
    EXPECT_THAT(refusal_of([&] { read(logs / "drive.log", of); }),
                HasSubstr("no frame with a mapped signal"));
}

TEST(CanMapping, JoinsItsTripToPositionsOfAReceiver) {
    const auto folder = test_folder();
    fs::copy_file(logs / "drive.log", folder / "drive.log");
    fs::copy_file(root / "tests/data/positions/gyor.nmea", folder / "drive.nmea");
    const auto of = mapping("[channels]\nacc_z_mps2 = {signal = \"VerticalAcc\"}\n"
                            "speed_mps = {signal = \"WheelBasedVehicleSpeed\"}\n");
    const auto trip = read(folder / "drive.log", of);
    EXPECT_THAT(trip.fixes, SizeIs(125));
    EXPECT_THAT(trip.meta.other, ::testing::Contains(::testing::Key("positions")));
}

// --------------------------------------------------------------------------------------- join

TEST(SignalRows, InterpolatesTheAxesOfOtherRecordsAtTheVerticalOne) {
    TableMapping table;
    table.channels = {{.channel = TripColumn::acc_x, .column = {}, .invalid = {}},
                      {.channel = TripColumn::acc_z, .column = {}, .invalid = {-1}}};
    SignalRows rows{table};
    using V = SignalRows::Value;
    rows.add(0.00, std::vector{V{0, 1}});
    rows.add(0.01, std::vector{V{1, 9}});
    rows.add(0.02, std::vector{V{0, 3}});
    rows.add(0.03, std::vector{V{1, -1}}); // no sample
    rows.add(0.50, std::vector{V{1, 10}}); // too far
    rows.finish();
    std::vector<TripRow> all;
    while (const auto row = rows.next()) {
        all.push_back(*row);
    }
    ASSERT_THAT(all, SizeIs(5));
    EXPECT_EQ(all[0].fault, RowReason::merged);
    EXPECT_EQ(all[1][TripColumn::acc_x], 2);
    EXPECT_EQ(all[1][TripColumn::acc_z], 9);
    EXPECT_TRUE(std::isnan(all[3][TripColumn::acc_z]));
    EXPECT_TRUE(std::isnan(all[4][TripColumn::acc_x]));
    EXPECT_EQ(all[4][TripColumn::acc_z], 10);
}

} // namespace
} // namespace macadam::testing
