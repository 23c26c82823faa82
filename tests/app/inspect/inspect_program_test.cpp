#include "support/program/places.hpp"
#include "support/program/program.hpp"
#include "support/program/shell.hpp"
#include "support/roads/drive.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const auto source = fs::path{source_folder()};

/// A drive of 1,000 m as a logger of unknown make writes it.
std::string foreign_log(const std::string& header) {
    const auto road = patched_road([](double) { return false; }, 1);
    const auto trip = drive_over(road, {.gnss_hz = 1}, *built_in_vehicle("golden-car"));
    auto text = header + "\n";
    std::size_t fix = 0;
    for (std::size_t i = 0; i < trip.acc.t_s.size(); ++i) {
        while (fix + 1 < trip.fixes.size() && trip.fixes[fix + 1].t_s <= trip.acc.t_s[i]) {
            ++fix;
        }
        text += fmt::format("{:.0f};{:.5f};{:.8f};{:.8f};{:.3f}\n",
                            trip.acc.t_s[i] * 1000,
                            trip.acc.z[i] / 9.80665,
                            trip.fixes[fix].at.lat_deg,
                            trip.fixes[fix].at.lon_deg,
                            trip.fixes[fix].speed_mps * 3.6);
    }
    return text;
}

const std::string plain_header = "millis;acc z (g);latitude;longitude;GPS speed (km/h)";

TEST(Inspect, ShowsColumnsQualityAndAMappingThatImportReads) {
    const auto folder = fresh_folder();
    const auto log = (folder / "drive.csv").string();
    const auto store = (folder / "roads.gpkg").string();
    write_file(log, foreign_log(plain_header));
    const auto shown = run_macadam({"inspect", log});
    EXPECT_EQ(shown.exit_status, 0) << shown.err;
    EXPECT_THAT(
        shown.out,
        AllOf(HasSubstr("drive.csv: CSV file of another program\n"),
              HasSubstr("layout         semicolons, time in ms, acceleration in g, GNSS "
                        "speed in km/h\n"),
              HasSubstr("acc_z_mps2     'acc z (g)', g; sure: unit in its name, and by "
                        "gravity\n"),
              HasSubstr("readings at 100 Hz; gravity 9.8"),
              HasSubstr("readings at 1 Hz near "),
              HasSubstr("gives          roughness along the trip (trace), the roads driven "
                        "(match), a map (import)\n"),
              HasSubstr("without        angular rates"),
              HasSubstr("[channels]\nacc_z_mps2 = {column = \"acc z (g)\", unit = \"g\"}")));

    EXPECT_EQ(run_macadam({"init", store, "--trace", log}).exit_status, 0);
    const auto detected = run_macadam({"import", store, log, "--method", "kf"});
    EXPECT_EQ(detected.exit_status, 0) << detected.err;
    EXPECT_THAT(detected.out,
                HasSubstr("note: read as semicolons, time in ms, acceleration in g, GNSS speed in "
                          "km/h (detected); 'macadam inspect' shows the mapping"));

    const auto mapping = (folder / "logger.toml").string();
    EXPECT_EQ(run_macadam({"inspect", log, "-o", mapping}).exit_status, 0);
    const auto mapped = run_macadam({"import", store, log, "--mapping", mapping, "--json"});
    EXPECT_THAT(mapped.out, HasSubstr("\"result\":\"known\"")); // the same content
}

TEST(Inspect, IsNamedByCommandsThatAreNotSureOfAColumn) {
    const auto folder = fresh_folder();
    const auto log = (folder / "drive.csv").string();
    write_file(log, foreign_log("millis;b;latitude;longitude;GPS speed (km/h)"));
    const auto traced = run_macadam({"trace", log});
    EXPECT_EQ(traced.exit_status, 1);
    EXPECT_THAT(traced.err,
                AllOf(HasSubstr("not found or not sure: vertical acceleration. 'macadam inspect "),
                      HasSubstr("writes a mapping for --mapping")));
    EXPECT_THAT(run_macadam({"inspect", log}).out,
                AllOf(HasSubstr("not found      vertical acceleration\n"),
                      HasSubstr("# acc_z_mps2 = {column = \"?\"")));
}

TEST(Inspect, SaysOfEveryKindOfFileWhichCommandTakesIt) {
    const auto folder = fresh_folder();
    const auto file = [&](const std::string& name, const std::string& text) {
        write_file(folder / name, text);
        return (folder / name).string();
    };
    const std::vector<std::pair<std::string, std::string>> cases{
        {file("a.pdf", "%PDF-1.7\n"), "PDF document"},
        {file("a.xlsx", "PK\x03\x04 [Content_Types].xml"), "save the sheet as CSV"},
        {file("profile.csv", "station_m,left_m\n0,0\n0.1,0\n"), "macadam iri FILE"},
        {file("laser.csv", "lat_deg,lon_deg,iri\n47,17,2\n47.001,17,2\n"), "--reference FILE"},
        {file("a.osm", "<?xml version='1.0'?>\n<osm version='0.6'>\n</osm>\n"), "init STORE"},
        {file("map.geojson", "{\"type\":\"FeatureCollection\",\"features\":[]}"), "GeoJSON"},
        {file("log.nmea", "$GPGGA,081530,4741.25,N,01738.07,E,1,8,1,110,M,,M,,*61\n"), "NMEA 0183"},
        {file("car.toml", read_file(source / "sample_data/fleet/recipe.toml")), "recipe of a"},
        {(source / "tests/data/loggers/racechrono.csv").string(), "layout         racechrono"}};
    for (const auto& [path, words] : cases) {
        const auto run = run_macadam({"inspect", path});
        EXPECT_EQ(run.exit_status, 0) << run.out << run.err;
        EXPECT_THAT(run.out, HasSubstr(words));
    }
}

TEST(Inspect, NamesLogsOfACanBusByTheirContentsAndSaysHowTheyAreRead) {
    const auto folder = fresh_folder();
    const std::vector<std::pair<std::string, std::string>> cases{
        {"LOGG\x90 and 144 bytes", "CAN log (Vector BLF): raw frames, not read"},
        {"date Sat Sep 30 15:06:13.191 2017\r\nbase hex  timestamps absolute\r\n"
         "internal events logged\r\n 0.01 1  123x  Rx   d 1 68\r\n 0.02 1  123x  Rx   d 1 68\r\n",
         "CAN log (Vector ASC): raw frames\n  next           read with --mapping"},
        {";$FILEVERSION=2.1\n;$STARTTIME=44548.6\n;$COLUMNS=N,O,T,I,d,L,D\n"
         "      1      1059.900 DT  0300 Rx 7  00 00\n",
         "CAN log (PEAK TRC): raw frames, not read"},
        {";##########\n;   Start time: 11.09.2002 08:59:42.\n;   PCAN-Net: TestNet\n"
         "1) 1841 0001 8 00 00 00 00 00 00 00 00\n",
         "CAN log (PEAK TRC): raw frames, not read"},
        {"(1533226488.230547) can0 260#08FFFB0000001884\n"
         "(1533226488.230560) vcan0 18FEF100##12C1\n",
         "CAN log (candump): raw frames\n  next           read with --mapping"},
        {" (2018-08-02 16:14:48.23)  can0  260   [2]  08 FF\n  can0  2C1   [0]\n",
         "CAN log (candump): raw frames\n  next           read with --mapping"},
        {"VERSION \"\"\n\nNS_ :\n\tCM_\n\nBS_:\n\nBU_: ESP\n\nBO_ 608 WHEELS: 8 ESP\n"
         " SG_ Left : 0|8@1+ (1,0) [0|0] \"km/h\" X\n",
         "description of CAN signals (DBC), 1 signal: WHEELS.Left [km/h]"}};
    for (const auto& [text, name] : cases) {
        const auto file = folder / "recording.txt"; // the name does not matter
        write_file(file, text);
        const auto run = run_macadam({"inspect", file.string()});
        EXPECT_EQ(run.exit_status, 0) << run.err;
        EXPECT_THAT(run.out,
                    AllOf(HasSubstr("recording.txt: " + name), Not(HasSubstr("[channels]"))));
    }
}

TEST(Inspect, ListsTheChannelsOfMdfAndShowsWhatAMappingGives) {
    const auto mdf = (source / "tests/data/mdf/drive.mf4").string();
    EXPECT_THAT(run_macadam({"inspect", mdf}).out,
                HasSubstr("measurement file (ASAM MDF 4), 9 channels: IMU.Acc, IMU.AccX [m/s^2]"));
    EXPECT_THAT(run_macadam({"inspect", (source / "tests/data/mdf/frames.mf4").string()}).out,
                AllOf(HasSubstr("measurement file (ASAM MDF 4): raw frames of a CAN bus"),
                      HasSubstr("dbc = \"car.dbc\"")));
    const auto mapping = (fresh_folder() / "car.toml").string();
    write_file(mapping, "[mdf]\n[channels]\nacc_z_mps2 = {signal = \"AccZ\"}\n");
    const auto run = run_macadam({"inspect", mdf, "--mapping", mapping});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.out,
                AllOf(HasSubstr("drive.mf4: log of another program, by its mapping"),
                      HasSubstr("acceleration   598 readings at 99.6 Hz"),
                      HasSubstr("positions: no roads, and no import")));
}

TEST(Inspect, FailsForWhatItDoesNotKnowAndGoesOn) {
    const auto folder = fresh_folder();
    write_file(folder / "a.bin", std::string("\x01\x00\x02 no idea", 12));
    write_file(folder / "b.txt", "one line of prose\n");
    write_file(folder / "empty.csv", "");
    const auto run = run_macadam({"inspect", folder.string(), (folder / "missing.csv").string()});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.out,
                AllOf(HasSubstr("a.bin: not recognised"),
                      HasSubstr("b.txt: text that is not a table"),
                      HasSubstr("empty.csv: empty file"),
                      HasSubstr("missing.csv: cannot be read")));
    EXPECT_THAT(run.err, HasSubstr("4 of 4 files not recognised or not readable"));
}

TEST(Inspect, ShowsTheCsvFilesOfAnArchive) {
    const auto folder = fresh_folder();
    fs::create_directory(folder / "may");
    write_file(folder / "may/drive.csv", foreign_log(plain_header));
    write_file(folder / "may/other.csv", foreign_log("a;b;c;d;e"));
    ASSERT_EQ(output_of(folder, fmt::format("cd '{}' && tar cf logs.tar may", folder.string())),
              "");
    const auto archive = folder / "logs.tar";
    const auto shown = run_macadam({"inspect", archive.string()});
    EXPECT_EQ(shown.exit_status, 0) << shown.err;
    EXPECT_THAT(
        shown.out,
        AllOf(HasSubstr("logs.tar/may/drive.csv: CSV file of another program\n"),
              HasSubstr("[channels]\nacc_z_mps2 = {column = \"acc z (g)\", unit = \"g\"}"),
              HasSubstr("logs.tar/may/other.csv: CSV file of another program\n"),
              HasSubstr("not found      time; vertical acceleration; speed of the car or of the "
                        "receiver; position (latitude, longitude)\n")));
}

TEST(Inspect, WritesOneMappingAndReplacesNoInput) {
    const auto folder = fresh_folder();
    const auto log = (folder / "drive.csv").string();
    write_file(log, foreign_log(plain_header));
    EXPECT_THAT(run_macadam({"inspect", log, log, "-o", (folder / "m.toml").string()}).err,
                HasSubstr("-o takes one CSV file of another program, or two of one trip, found 2"));
    EXPECT_FALSE(fs::exists(folder / "m.toml"));
    EXPECT_EQ(run_macadam({"inspect", log, "-o", log}).exit_status, 1);
    EXPECT_EQ(read_file(log), foreign_log(plain_header));
}

TEST(Inspect, JoinsAccelerationsAndPositionsOfOneTrip) {
    const auto folder = fresh_folder();
    const auto road = patched_road([](double) { return false; }, 1);
    const auto trip = drive_over(road, {.gnss_hz = 1}, *built_in_vehicle("golden-car"));
    std::string imu = "%time,linear_acceleration.z\n"; // as 'rostopic echo -p' writes it
    std::string gps = "%time,latitude,longitude,ground_speed (m/s)\n";
    const auto time = [](double t_s) { return fmt::format("{:.0f}", (1.7e9 + t_s) * 1e9); };
    for (std::size_t i = 0; i < trip.acc.t_s.size(); ++i) {
        imu += fmt::format("{},{:.5f}\n", time(trip.acc.t_s[i]), trip.acc.z[i]);
    }
    for (const auto& fix : trip.fixes) {
        gps += fmt::format("{},{:.8f},{:.8f},{:.3f}\n",
                           time(fix.t_s),
                           fix.at.lat_deg,
                           fix.at.lon_deg,
                           fix.speed_mps);
    }
    const auto drives = folder / "drives";
    fs::create_directory(drives);
    write_file(drives / "monday_imu.csv", imu);
    write_file(drives / "monday_gps.csv", gps);
    EXPECT_THAT(run_macadam({"inspect", drives.string()}).out,
                HasSubstr("monday_gps.csv: one trip in two files, accelerations in one and "
                          "positions of the same time in the other"));

    const auto mapping = (folder / "logger.toml").string();
    const auto written = run_macadam({"inspect",
                                      (drives / "monday_gps.csv").string(),
                                      (drives / "monday_imu.csv").string(),
                                      "-o",
                                      mapping});
    ASSERT_EQ(written.exit_status, 0) << written.err;
    EXPECT_THAT(read_file(mapping),
                AllOf(HasSubstr("files = \"*_imu.csv\"\n"),
                      HasSubstr("[[file]]\nfiles = \"*_gps.csv\"\n")));
    const auto traced = run_macadam({"trace", drives.string(), "--mapping", mapping});
    EXPECT_EQ(traced.exit_status, 0) << traced.err;
    EXPECT_THAT(traced.out, HasSubstr("validity"));
}

TEST(Inspect, TakesNoOtherTableOrJsonForALogOrAMap) {
    const auto folder = fresh_folder();
    write_file(folder / "shop.csv", "name,price\nbread,2\nmilk,3\n");
    write_file(folder / "x.json", "{\"a\":1}\n");
    const auto run = run_macadam({"inspect", folder.string()});
    EXPECT_THAT(run.out,
                AllOf(HasSubstr("no column of a trip log was recognised"),
                      HasSubstr("x.json: JSON\n"),
                      Not(HasSubstr("[channels]")),
                      Not(HasSubstr("GeoJSON"))));
}

TEST(Inspect, PrintsJsonWithEveryColumn) {
    const auto folder = fresh_folder();
    const auto log = (folder / "drive.csv").string();
    write_file(log, foreign_log(plain_header));
    const auto run = run_macadam({"inspect", log, "--json"});
    EXPECT_THAT(run.out,
                AllOf(HasSubstr("{\"channel\":\"t_s\",\"column\":1,\"name\":\"millis\",\"unit\":"
                                "\"ms\",\"confidence\":\"sure\""),
                      HasSubstr("\"sure\":true"),
                      HasSubstr("\"gives_roughness\":true"),
                      HasSubstr("\"error\":null")));
    EXPECT_THAT(run.out, Not(HasSubstr("nan")));
}

} // namespace
} // namespace macadam::testing
