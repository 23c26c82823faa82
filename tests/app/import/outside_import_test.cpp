// Trips that touch no road of the map, folders without trips, and trips imported before.

#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string log_from(const GeoPoint& start, const std::string& trip_id) {
    const Drive drive{.start = start, .length_m = 600, .trip_id = trip_id};
    return text_of(drive_over(patched_road([](double) { return false; }, 1),
                              drive,
                              *built_in_vehicle("golden-car")),
                   drive);
}

struct World {
    fs::path folder;
    std::string trips; ///< folder with a trip on the map
    std::string store;
};

World world() {
    World made{fresh_folder(), {}, {}};
    made.trips = (made.folder / "trips").string();
    made.store = (made.folder / "roads.gpkg").string();
    const auto inside = made.folder / "trips" / "inside.trip.csv";
    fs::create_directories(made.trips);
    write_file(inside, log_from({48, 11}, "inside"));
    EXPECT_EQ(run_macadam({"init", made.store, "--trace", inside.string()}).exit_status, 0);
    return made;
}

Run import_kf(const World& made, std::vector<std::string> words) {
    words.insert(words.begin(), {"import", made.store});
    words.insert(words.end(), {"--method", "kf"});
    return run_macadam(words);
}

TEST(OutsideImport, StoresNoTripThatTouchesNoRoad) {
    const auto made = world();
    const auto away = (made.folder / "away.trip.csv").string();
    write_file(away, log_from({47.69, 17.67}, "away"));
    const auto digest = run_macadam({"info", made.store, "--digest"}).out;
    for (int i = 0; i < 2; ++i) { // the same on every repeat
        const auto run = import_kf(made, {away, "--json"});
        EXPECT_EQ(run.exit_status, 1);
        EXPECT_THAT(run.out, HasSubstr("\"result\":\"outside\""));
        EXPECT_THAT(run.err,
                    HasSubstr("macadam import: the trip does not touch this map: trip near 47.69, "
                              "17.67; map covers 11.00,48.00 to "));
    }
    EXPECT_EQ(run_macadam({"info", made.store, "--digest"}).out, digest);
    EXPECT_THAT(run_macadam({"info", made.store, "--json"}).out, HasSubstr("\"trips\":0,"));
}

TEST(OutsideImport, WarnsOnceIfOtherTripsAreInside) {
    const auto made = world();
    write_file(fs::path{made.trips} / "a.trip.csv", log_from({47.69, 17.67}, "a"));
    write_file(fs::path{made.trips} / "b.trip.csv", log_from({11, 48}, "b"));
    const auto run = import_kf(made, {made.trips});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("a.trip.csv: touches no road of this map, not stored"));
    EXPECT_THAT(
        run.err,
        AllOf(HasSubstr("1 trip imported, 0 already imported, 0 rejected, 2 outside the map"),
              HasSubstr("warning: 2 of 3 trips are outside this map: trips near 47.69, "
                        "17.67 and 11.00, 48.00; map covers"),
              HasSubstr("latitude and longitude are probably exchanged")));
}

TEST(OutsideImport, OfAFolderWithoutTripsSaysWhatIsThere) {
    const auto made = world();
    const auto empty = made.folder / "empty";
    fs::create_directories(empty);
    write_file(empty / "notes.txt", "x");
    const auto run = import_kf(made, {empty.string()});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err,
                AllOf(HasSubstr("empty: contains no trip log (*.trip.csv, *.trip.csv.gz, "),
                      HasSubstr("1 file ignored: notes.txt"),
                      HasSubstr("no trip log was found: nothing was imported")));
}

TEST(RepeatedImport, WithOtherSettingsSaysSoInOneLine) {
    const auto made = world();
    write_file(fs::path{made.trips} / "second.trip.csv", log_from({48, 11}, "second"));
    EXPECT_EQ(import_kf(made, {made.trips}).exit_status, 0);
    EXPECT_THAT(import_kf(made, {made.trips}).err, Not(HasSubstr("imported before")));
    const auto smoothed = run_macadam({"import", made.store, made.trips});
    EXPECT_EQ(smoothed.exit_status, 0);
    EXPECT_THAT(smoothed.err,
                HasSubstr(fmt::format("warning: 2 trips were imported before with --method kf and "
                                      "stay so; to apply other options: macadam reprocess {} {}",
                                      made.store,
                                      made.trips)));
    EXPECT_THAT(import_kf(made, {made.trips, "--vehicle", "generic"}).err,
                HasSubstr("2 trips were imported before with --vehicle golden-car"));
}

TEST(EmptyMap, IsToldWithWhatToDoNext) {
    const auto made = world();
    const auto out = [&](const char* name) { return (made.folder / name).string(); };
    const std::vector<std::vector<std::string>> commands{
        {"render", made.store, "-o", out("map.png"), "--size", "400x300"},
        {"report", made.store, "-o", out("report.html")},
        {"export", made.store, "-o", out("roads.geojson")},
        {"query", made.store, "--worst", "1", "--segments"}};
    for (const auto& words : commands) {
        const auto run = run_macadam(words);
        EXPECT_EQ(run.exit_status, 0) << run.err;
        EXPECT_THAT(run.err,
                    HasSubstr(fmt::format("warning: {}: the map is empty: no trips yet; 'macadam "
                                          "import {} TRIPS' adds them",
                                          made.store,
                                          made.store)));
    }
    EXPECT_THAT(read_file(out("report.html")), HasSubstr("No measurements yet."));
}

} // namespace
} // namespace macadam::testing
