// The program as users run it: the whole line from real logs to maps.

#include "support/program/places.hpp"
#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

const fs::path sample_data = fs::path{source_folder()} / "sample_data";
const auto rav4 = (sample_data / "comma2k19/comma2k19_rav4.trip.csv").string();
const auto gyor = (sample_data / "gyor/gyor_q3_00.trip.csv").string();

Run expect_done(const std::vector<std::string>& words) {
    auto run = run_macadam(words);
    EXPECT_EQ(run.exit_status, 0) << words.front() << ": " << run.err;
    return run;
}

std::string digest_of(const fs::path& store) {
    return expect_done({"info", store.string(), "--digest"}).out;
}

std::size_t lines_in(const std::string& text) {
    return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

/// A store of the RAV4's road with its trip in it.
fs::path store_of_rav4(const fs::path& folder) {
    const auto store = folder / "roads.gpkg";
    expect_done({"init", store.string(), "--trace", rav4});
    expect_done({"import", store.string(), rav4, "--method", "kf"});
    return store;
}

TEST(Program, SaysItsVersion) {
    EXPECT_THAT(expect_done({"--version"}).out, MatchesRegex("macadam [0-9.]+\n"));
    EXPECT_EQ(expect_done({"-V"}).out, expect_done({"--version"}).out);
}

TEST(Program, ExplainsEveryCommand) {
    for (const auto* name : {"init",
                             "import",
                             "query",
                             "export",
                             "render",
                             "report",
                             "info",
                             "iri",
                             "trace",
                             "match"}) {
        EXPECT_THAT(expect_done({name, "--help"}).out, HasSubstr("example"));
    }
}

TEST(Program, HelpsWithACommand) {
    EXPECT_EQ(expect_done({"help", "render"}).out, expect_done({"render", "--help"}).out);
    EXPECT_EQ(expect_done({"help"}).out, expect_done({"--help"}).out);
    EXPECT_THAT(expect_done({"init", "--help-all"}).out, HasSubstr("--oneway-column"));
    const auto unknown = run_macadam({"help", "rendr"});
    EXPECT_EQ(unknown.exit_status, 2);
    EXPECT_THAT(unknown.err, HasSubstr("unknown command 'rendr'; did you mean render?"));
}

TEST(Program, TakesEarlierSpellingsOfOptionsWithANoteAndRefusesThoseThatMeantSomethingElse) {
    const auto store = store_of_rav4(fresh_folder()).string();
    const auto present = expect_done({"query", store, "--road", "none", "--json"});
    const auto earlier = expect_done({"query", store, "--name", "none", "--json"});
    EXPECT_EQ(earlier.out, present.out);
    EXPECT_EQ(earlier.err, "macadam: note: --name is called --road now\n" + present.err);
    EXPECT_EQ(expect_done({"query", store, "--name", "none", "--json", "--quiet"}).err, "");
    const auto refused = run_macadam({"iri", "a.csv", "--from", "2"});
    EXPECT_EQ(refused.exit_status, 2);
    EXPECT_THAT(refused.err, HasSubstr("--from is called --from-m here now"));
}

TEST(Program, WritesRowsToAFileInTheFormatOfItsSuffix) {
    const auto folder = fresh_folder();
    const auto store = store_of_rav4(folder).string();
    const auto file = folder / "worst.csv";
    const auto into =
        expect_done({"query", store, "--worst", "3", "--segments", "-o", file.string()});
    EXPECT_EQ(into.out, "");
    EXPECT_EQ(read_file(file),
              expect_done({"query", store, "--worst", "3", "--segments", "--format", "csv"}).out);
    EXPECT_EQ(run_macadam({"query", store, "--worst", "3", "--json", "-o", store}).exit_status, 1);
    EXPECT_EQ(
        run_macadam({"query", store, "--worst", "3", "--json", "--format", "csv"}).exit_status, 2);
}

TEST(Program, LeavesNoFileOfRowsWhenACommandFails) {
    const auto folder = fresh_folder();
    const auto file = folder / "rows.csv";
    EXPECT_EQ(run_macadam({"trace", rav4, "--length", "90000", "-o", file.string()}).exit_status,
              1);
    EXPECT_TRUE(fs::is_empty(folder));
    expect_done({"trace", rav4, "--method", "kf", "-o", file.string()});
    EXPECT_THAT(read_file(file), StartsWith("from_m,to_m,"));
}

TEST(Program, PrintsNothingOfAcceptedTripsWhenQuiet) {
    const auto folder = fresh_folder();
    const auto store = (folder / "roads.gpkg").string();
    expect_done({"init", store, "--trace", rav4});
    EXPECT_EQ(expect_done({"import", store, rav4, "--method", "kf", "--quiet"}).out, "");
    write_file(folder / "broken.trip.csv", "# macadam-trip 1\n");
    const auto broken =
        run_macadam({"import", store, (folder / "broken.trip.csv").string(), "--quiet"});
    EXPECT_THAT(broken.out, StartsWith("rejected"));
}

TEST(Program, IsMisusedByWhatItDoesNotKnow) {
    EXPECT_EQ(run_macadam({}).exit_status, 2);
    EXPECT_EQ(run_macadam({"fly"}).exit_status, 2);
    EXPECT_EQ(run_macadam({"info"}).exit_status, 2);
    EXPECT_EQ(run_macadam({"info", "roads.gpkg", "--fast"}).exit_status, 2);
}

TEST(Program, MapsARealTripFromItsLogToItsPicture) {
    const auto folder = fresh_folder();
    const auto store = store_of_rav4(folder);

    const auto geojson = folder / "roads.geojson";
    expect_done({"export", store.string(), "-o", geojson.string()});
    EXPECT_THAT(read_file(geojson), StartsWith("{\"type\":\"FeatureCollection\""));
    EXPECT_THAT(read_file(geojson), HasSubstr("\"iri\":"));

    const auto picture = folder / "map.png";
    expect_done({"render", store.string(), "-o", picture.string(), "--size", "512x512"});
    EXPECT_THAT(read_file(picture), StartsWith("\x89PNG"));

    EXPECT_THAT(expect_done({"info", store.string()}).out, HasSubstr("1 vehicle, "));
}

TEST(Program, AccountsForEveryRowOfTheRealTrips) {
    const auto folder = fresh_folder();
    const auto store = folder / "roads.gpkg";
    expect_done({"init", store.string(), "--trace", rav4});
    const auto lines =
        expect_done({"import", store.string(), rav4, gyor, "--json", "--method", "kf"}).out;
    EXPECT_THAT(lines, HasSubstr("\"rows_read\":11808"));
    EXPECT_THAT(lines, HasSubstr("\"rows_read\":25770"));
    EXPECT_EQ(lines_in(lines), 2U);
}

TEST(Program, LetsAKnownTripChangeNothing) {
    const auto store = store_of_rav4(fresh_folder());
    const auto before = digest_of(store);
    const auto again = expect_done({"import", store.string(), rav4, "--json", "--method", "kf"});
    EXPECT_THAT(again.out, HasSubstr("\"result\":\"known\""));
    EXPECT_EQ(digest_of(store), before);
}

TEST(Program, GivesOneDigestWhateverTheOrderAndTheJobs) {
    const auto folder = fresh_folder();
    const auto first = folder / "a.gpkg";
    const auto second = folder / "b.gpkg";
    expect_done({"init", first.string(), "--trace", rav4});
    expect_done({"init", second.string(), "--trace", rav4});
    expect_done({"import", first.string(), rav4, gyor, "--method", "kf"});
    expect_done({"import", second.string(), gyor, rav4, "--jobs", "2", "--method", "kf"});
    EXPECT_EQ(digest_of(first), digest_of(second));
    EXPECT_THAT(digest_of(first), MatchesRegex("[0-9a-f]{64}\n"));
}

TEST(Program, ImportsAFolderOfSimulatedCarsAndFindsTheRoughPatch) {
    const auto folder = fresh_folder();
    fs::create_directories(folder / "trips/monday");
    const auto road = patched_road([](double x_m) { return x_m >= 500 && x_m < 600; }, 4);
    for (const double speed_mps : {15.0, 22.0}) {
        const Drive drive{
            .length_m = 1200, .speed_mps = speed_mps, .trip_id = fmt::format("at-{}", speed_mps)};
        write_file(folder / fmt::format("trips/monday/{}.trip.csv", drive.trip_id),
                   text_of(drive_over(road, drive, *built_in_vehicle("golden-car")), drive));
    }
    write_file(folder / "trips/notes.txt", "not a trip");

    const auto store = (folder / "roads.gpkg").string();
    expect_done({"init", store, "--trace", (folder / "trips").string()});
    const auto import =
        expect_done({"import", store, (folder / "trips").string(), "--method", "kf"});
    EXPECT_THAT(import.err, HasSubstr("2 trips imported"));

    const auto worst =
        expect_done({"query", store, "--worst", "1", "--segments", "--format", "csv"}).out;
    EXPECT_EQ(lines_in(worst), 2U);
    EXPECT_THAT(worst, HasSubstr(",poor,2,1,"));
    const auto stretches =
        expect_done({"query", store, "--worst", "5", "--min-length", "60", "--format", "csv"}).out;
    EXPECT_EQ(lines_in(stretches), 2U) << stretches; // the patch is one stretch
    EXPECT_THAT(stretches, HasSubstr(",2,2,1,"));    // of two passes by one car
}

TEST(Program, TakesATownOfOpenStreetMapAsItsNetworkAndNamesWhoseItIs) {
    const auto folder = fresh_folder();
    const auto store = (folder / "town.gpkg").string();
    const auto town = fs::path{source_folder()} / "tests/data/osm/harrisburg.osm.pbf";
    EXPECT_THAT(expect_done({"init", store, "--network", town.string()}).err,
                HasSubstr("2475 ways"));

    const auto all = (folder / "all.geojson").string();
    expect_done({"export", store, "-o", all, "--all", "--bbox", "-76.82,40.26,-76.80,40.27"});
    EXPECT_THAT(read_file(all), HasSubstr("OpenStreetMap contributors"));
    EXPECT_THAT(read_file(all), HasSubstr("\"iri\":null"));
    EXPECT_THAT(expect_done({"query", store, "--road", "derry", "--all"}).out,
                HasSubstr("Derry Street"));
}

TEST(Program, TracesATripWithoutAMap) {
    const auto csv = expect_done({"trace", rav4, "--vehicle", "generic", "--method", "kf"}).out;
    EXPECT_THAT(csv,
                StartsWith("from_m,to_m,t_s,lat_deg,lon_deg,speed_mps,iri,iri_sd,iri_low,iri_high,"
                           "iri_left,iri_right,mri,hri,index,validity\n0.000,20.000,"));
    EXPECT_NEAR(
        static_cast<double>(lines_in(csv)), 50, 3); // 1.00 km in pieces of 20 m, and the header
}

/// 220 m of a simulated car, so that sanitizers see it in seconds.
TEST(Program, TracesByTheSmootherUnlessToldOtherwise) {
    const auto folder = fresh_folder();
    const Drive drive{.length_m = 220};
    const auto road = patched_road([](double) { return true; }, 1);
    const auto trip = (folder / "short.trip.csv").string();
    write_file(trip, text_of(drive_over(road, drive, *built_in_vehicle("golden-car")), drive));
    const auto plain = expect_done({"trace", trip}).out;
    EXPECT_EQ(plain, expect_done({"trace", trip, "--method", "smoother"}).out);
    EXPECT_NE(plain, expect_done({"trace", trip, "--method", "kf"}).out);
    EXPECT_THAT(plain, HasSubstr(",HRI,ok\n"));
}

TEST(Program, WarnsThatItDoesNotKnowTheCar) {
    const auto run = expect_done({"trace", rav4, "--method", "kf"});
    EXPECT_THAT(run.err, HasSubstr("warning: car 'b0c9d2329ad1606b' unknown"));
}

TEST(Program, FindsTheVehicleFileOfATripInTheFolderBeside) {
    const auto folder = fresh_folder();
    fs::create_directories(folder / "trips");
    fs::create_directories(folder / "vehicles");
    const Drive drive{.length_m = 600, .vehicle_id = "taxi-9"};
    const auto road = patched_road([](double) { return false; }, 1);
    const auto trip = folder / "trips/a.trip.csv";
    write_file(trip, text_of(drive_over(road, drive, *built_in_vehicle("golden-car")), drive));
    write_file(folder / "vehicles/taxi.toml",
               "name = \"taxi-9\"\n[half_car]\nms_kg = 1000\nmu_kg = 37.5\nks_n_per_m = 15825\n"
               "cs_ns_per_m = 1500\nkt_n_per_m = 163250\nis_kgm2 = 400\nl_m = 0.75\n");
    EXPECT_THAT(expect_done({"trace", trip.string(), "--method", "kf"}).err, IsEmpty());
}

TEST(Program, KeepsNoVehicleIdInTheStore) {
    const auto folder = fresh_folder();
    fs::create_directories(folder / "vehicles");
    const Drive drive{.length_m = 600, .vehicle_id = "plate-AB-1234"};
    const auto road = patched_road([](double) { return false; }, 1);
    const auto trip = (folder / "a.trip.csv").string();
    write_file(trip, text_of(drive_over(road, drive, *built_in_vehicle("golden-car")), drive));
    write_file(
        folder / "vehicles/a.toml",
        "name = \"plate-AB-1234\"\n[half_car]\nms_kg = 1000\nmu_kg = 37.5\nks_n_per_m = 15825\n"
        "cs_ns_per_m = 1500\nkt_n_per_m = 163250\nis_kgm2 = 400\nl_m = 0.75\n");
    const auto store = folder / "roads.gpkg";
    expect_done({"init", store.string(), "--trace", trip});
    EXPECT_THAT(expect_done({"import", store.string(), trip, "--method", "kf"}).out,
                HasSubstr("car 'plate-AB-1234'"));
    EXPECT_THAT(read_file(store), Not(HasSubstr("plate-AB-1234")));
}

TEST(Program, GivesTheWorstOfWhatIsNearTheWorstFirst) {
    const auto store = store_of_rav4(fresh_folder()).string();
    const std::vector<std::string> near{
        "query", store, "--near", "37.7258,-122.4720", "--radius", "60", "--format", "csv"};
    auto worst = near;
    worst.insert(worst.end(), {"--worst", "2", "--segments"});
    const auto all = expect_done(near).out;
    const auto two = expect_done(worst).out;
    EXPECT_GT(lines_in(all), 4U);
    EXPECT_EQ(lines_in(two), 3U);
    auto elsewhere = near;
    elsewhere.insert(elsewhere.end(), {"--bbox", "10,10,11,11"});
    EXPECT_EQ(lines_in(expect_done(elsewhere).out), 1U); // the header
}

TEST(Program, SaysIriOfASineAsTheClosedFormDoes) {
    const auto folder = fresh_folder();
    std::string csv = "station_m,left_m,right_m\n";
    for (int i = 0; i <= 8000; ++i) {
        const double x_m = 0.05 * i;
        const double z_m = 0.001 * std::sin(2 * 3.14159265358979 * x_m / 2.4);
        csv += fmt::format("{:.3f},{:.9f},{:.9f}\n", x_m, z_m, z_m);
    }
    write_file(folder / "sine.csv", csv);
    // 2.7241 mm/m is the closed form for 1 mm at 2.4 m; the 0.05 m grid reads 2.7223.
    const auto out =
        expect_done(
            {"iri", (folder / "sine.csv").string(), "--from-m", "100", "--to-m", "388", "--json"})
            .out;
    EXPECT_THAT(out, HasSubstr("\"mri\":2.722"));
    EXPECT_THAT(out, HasSubstr("\"envelope_samples\":5"));
}

TEST(Program, MatchesARealTripToARoadOfItsOwn) {
    const auto folder = fresh_folder();
    const auto store = store_of_rav4(folder);
    const auto roads = (folder / "roads.geojson").string();
    expect_done({"export", store.string(), "-o", roads, "--all"});
    const auto pieces = expect_done({"match", rav4, "--network", roads});
    EXPECT_THAT(pieces.out, HasSubstr(",road,"));
}

/// At 10 m/s for a minute, with a pause that only shows as a jump of 800 m in its middle.
std::string log_with_a_hidden_pause() {
    constexpr double deg_per_m = 1 / 111320.0; // of longitude, near the equator
    std::string log = "# macadam-trip 1\nt_s,speed_mps,lat_deg,lon_deg\n";
    for (int i = 0; i <= 600; ++i) {
        const double east_m = i + (i > 300 ? 800 : 0);
        log += i % 10 == 0 ? fmt::format("{:.1f},10,0.5,{:.8f}\n", i / 10.0, 6 + east_m * deg_per_m)
                           : fmt::format("{:.1f},10,,\n", i / 10.0);
    }
    return log + "# end rows: 601\n";
}

TEST(Program, MatchesNoWayToAPauseOfTheRecording) {
    const auto folder = fresh_folder();
    const auto store = store_of_rav4(folder).string(); // in California, far off
    write_file(folder / "paused.trip.csv", log_with_a_hidden_pause());
    const auto run =
        expect_done({"match", (folder / "paused.trip.csv").string(), "--network", store});
    // 600 m were driven, and it is known to a second or so when the pause was.
    EXPECT_THAT(run.err, ContainsRegex("0\\.(59|60|61) km off the network"));
}

TEST(Program, MatchesATripToTheRoadsOfAStoreButMakesNoStoreOfOne) {
    const auto folder = fresh_folder();
    const auto store = store_of_rav4(folder).string();
    const auto pieces = expect_done({"match", rav4, "--network", store}).out;
    EXPECT_THAT(pieces, HasSubstr("\n1,1,")); // way 1 from its node 1: one road, as it was traced
    const auto again = run_macadam({"init", (folder / "b.gpkg").string(), "--network", store});
    EXPECT_EQ(again.exit_status, 1);
    EXPECT_THAT(again.err, HasSubstr("is a road database, expected the map"));
}

} // namespace
} // namespace macadam::testing
