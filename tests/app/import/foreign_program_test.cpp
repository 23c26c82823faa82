// Logs of other makers as users hand them to the program.

#include "storage/trips/log/trip_writer.hpp"
#include "support/program/places.hpp"
#include "support/program/program.hpp"
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

const auto loggers = fs::path{source_folder()} / "tests/data/loggers";

/// A drive of 1,000 m as phyphox exports it from a phone that lies flat.
fs::path phyphox_export(const fs::path& folder) {
    const auto road = patched_road([](double) { return false; }, 1);
    const auto trip = drive_over(road, {.gnss_hz = 1}, *built_in_vehicle("golden-car"));
    std::string acc = "\"Time (s)\",\"X (m/s^2)\",\"Y (m/s^2)\",\"Z (m/s^2)\"\n";
    for (std::size_t i = 0; i < trip.acc.t_s.size(); ++i) {
        acc += fmt::format("{:.9E},0.0E0,0.0E0,{:.9E}\n", trip.acc.t_s[i], trip.acc.z[i]);
    }
    std::string places = "\"Time (s)\",\"Latitude (°)\",\"Longitude (°)\",\"Height (m)\","
                         "\"Velocity (m/s)\",\"Direction (°)\",\"Horizontal Accuracy (m)\"\n";
    for (const auto& fix : trip.fixes) {
        places += fmt::format("{:.9E},{:.9E},{:.9E},1.0E2,{:.9E},9.0E1,5.0E0\n",
                              fix.t_s,
                              fix.at.lat_deg,
                              fix.at.lon_deg,
                              fix.speed_mps);
    }
    fs::create_directories(folder);
    write_file(folder / "Accelerometer.csv", acc);
    write_file(folder / "Location.csv", places);
    return folder;
}

TEST(ForeignLogs, GoThroughEveryCommandThatTakesTrips) {
    const auto folder = fresh_folder();
    const auto phone = phyphox_export(folder / "phone").string();
    const auto store = (folder / "roads.gpkg").string();
    EXPECT_EQ(run_macadam({"init", store, "--trace", phone}).exit_status, 0);
    EXPECT_THAT(run_macadam({"trace", phone, "--vehicle", "golden-car", "--method", "kf"}).out,
                HasSubstr(",HRI,ok"));
    EXPECT_THAT(run_macadam({"match", phone, "--network", store}).out, HasSubstr(",road,"));
    const auto import = run_macadam({"import", store, phone, "--json", "--method", "kf"});
    EXPECT_EQ(import.exit_status, 0) << import.err;
    EXPECT_THAT(import.out, HasSubstr("\"trip_id\":\"phone\""));
    EXPECT_THAT(import.out, HasSubstr("\"rows_read\":5052,")); // 5,001 of 100 Hz, 51 of 1 Hz
}

TEST(ForeignLogs, AreOfTheCarThatVehicleIdNames) {
    const auto folder = fresh_folder();
    const auto phone = phyphox_export(folder / "trips/phone").string();
    const auto store = (folder / "roads.gpkg").string();
    run_macadam({"init", store, "--trace", phone});
    fs::create_directory(folder / "vehicles");
    run_macadam({"vehicles",
                 "add",
                 "--mass",
                 "1430",
                 "--wheelbase",
                 "2.62",
                 "--body",
                 "compact",
                 "-o",
                 (folder / "vehicles/golf.toml").string()});
    const auto import = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"import", store, phone, "--method", "kf"};
        words.insert(words.end(), more.begin(), more.end());
        return run_macadam(words);
    };
    const auto imported = import({"--vehicle-id", "golf"});
    EXPECT_EQ(imported.exit_status, 0) << imported.err;
    EXPECT_THAT(imported.out, AllOf(HasSubstr("car 'golf'"), Not(HasSubstr("car unknown"))));
    EXPECT_THAT(import({"--vehicle-id", "golf"}).out, Not(HasSubstr("note:")));
    const auto other = import({"--vehicle-id", "polo"});
    EXPECT_EQ(other.exit_status, 0) << other.err;
    EXPECT_THAT(other.out,
                AllOf(HasSubstr("was imported for another car, or for none; its car is unchanged"),
                      HasSubstr("macadam forget " + store + " --trip ")));
    const auto reprocess = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"reprocess", store, phone, "--method", "kf"});
        return run_macadam(more);
    };
    const auto contradicted = reprocess({"--vehicle-id", "polo"});
    EXPECT_EQ(contradicted.exit_status, 1);
    EXPECT_THAT(contradicted.out + contradicted.err, HasSubstr("its car is unchanged"));
    const auto again = reprocess({});
    EXPECT_EQ(again.exit_status, 0) << again.err;
    EXPECT_THAT(again.out, AllOf(HasSubstr("car 'golf'"), Not(HasSubstr("car unknown"))));

    EXPECT_EQ(run_macadam({"forget", store, "--vehicle-id", "polo"}).exit_status, 1);
    EXPECT_EQ(run_macadam({"forget", store, "--vehicle-id", "golf"}).exit_status, 0);
    EXPECT_THAT(import({"--vehicle-id", "polo", "--take-back"}).out, HasSubstr("imported  "));
    EXPECT_EQ(run_macadam({"forget", store, "--vehicle-id", "polo"}).exit_status, 0);
}

TEST(ForeignLogs, ThatNameTheirCarAreNotGivenAnotherOne) {
    const auto folder = fresh_folder();
    auto trip = drive_over(patched_road([](double) { return false; }, 1),
                           {.gnss_hz = 1},
                           *built_in_vehicle("golden-car"));
    trip.meta.vehicle_id = "van-7";
    const auto file = (folder / "a.trip.csv").string();
    write_trip(trip, file);
    const auto store = (folder / "roads.gpkg").string();
    run_macadam({"init", store, "--trace", file});
    const auto refused =
        run_macadam({"import", store, file, "--vehicle-id", "golf", "--vehicle", "golden-car"});
    EXPECT_EQ(refused.exit_status, 1);
    EXPECT_THAT(
        refused.out,
        HasSubstr("a.trip.csv: its vehicle_id is 'van-7', not 'golf': --vehicle-id names the "
                  "car of logs that name none"));
    EXPECT_EQ(
        run_macadam({"trace", file, "--vehicle-id", "golf", "--vehicle", "golden-car"}).exit_status,
        1);
    EXPECT_EQ(run_macadam({"import", store, file, "--vehicle-id", "  "}).exit_status, 2);
    EXPECT_THAT(run_macadam({"import", store, file, "--vehicle-id", "  "}).err,
                HasSubstr("--vehicle-id is '  ', expected a name of 1 to 100 characters"));
}

TEST(ForeignLogs, LoseTheirEndsByTrimAndSaySo) {
    const auto folder = fresh_folder();
    const auto phone = phyphox_export(folder / "phone").string();
    const auto store = (folder / "roads.gpkg").string();
    run_macadam({"init", store, "--trace", phone});
    const auto import = run_macadam({"import", store, phone, "--trim", "300", "--method", "kf"});
    EXPECT_THAT(import.out, HasSubstr(" trimmed"));
    EXPECT_THAT(import.out, HasSubstr("note: the first and last 300 m were removed"));
}

TEST(ForeignLogs, ThatAreKnownKeepTheirEndsInSpiteOfTrimWhichIsSaid) {
    const auto folder = fresh_folder();
    const auto phone = phyphox_export(folder / "phone").string();
    const auto store = (folder / "roads.gpkg").string();
    run_macadam({"init", store, "--trace", phone});
    run_macadam({"import", store, phone, "--method", "kf"});
    const auto again = run_macadam({"import", store, phone, "--trim", "300", "--method", "kf"});
    EXPECT_THAT(again.out, HasSubstr("skipped "));
    EXPECT_THAT(again.out, HasSubstr("note: was imported before and stays unchanged"));
    EXPECT_THAT(run_macadam({"import", store, phone, "--method", "kf"}).out,
                Not(HasSubstr("note:")));
}

TEST(ForeignLogs, AreReadByAMapping) {
    const auto folder = fresh_folder();
    const auto store = (folder / "roads.gpkg").string();
    const auto phone = phyphox_export(folder / "phone").string();
    run_macadam({"init", store, "--trace", phone});
    const auto match = run_macadam({"match",
                                    (loggers / "racechrono.csv").string(),
                                    "--mapping",
                                    "racechrono",
                                    "--network",
                                    store});
    EXPECT_EQ(match.exit_status, 0) << match.err;
    EXPECT_THAT(match.out, HasSubstr("off_network")); // a circuit far from there
}

TEST(ForeignLogs, TooSlowForRoughnessAreRefused) {
    const auto trace =
        run_macadam({"trace", (loggers / "trackaddict.csv").string(), "--mapping", "trackaddict"});
    EXPECT_EQ(trace.exit_status, 1);
    EXPECT_THAT(trace.err, HasSubstr("Hz, expected at least 40"));
}

TEST(ForeignLogs, AreMisusedByAWrongTrimOrMapping) {
    const auto trim = run_macadam({"import", "roads.gpkg", "x.zip", "--trim", "-1"});
    EXPECT_EQ(trim.exit_status, 2);
    EXPECT_THAT(trim.err, HasSubstr("--trim is -1, expected 0 to 100000 m"));
    const auto mapping = run_macadam({"trace", "x.csv", "--mapping", "harrys"});
    EXPECT_EQ(mapping.exit_status, 2);
    EXPECT_THAT(mapping.err, HasSubstr("--mapping is 'harrys', expected a TOML file or one of"));
}

} // namespace
} // namespace macadam::testing
