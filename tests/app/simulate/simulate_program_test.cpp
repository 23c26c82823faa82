// `simulate` and what holds a store against its truth, by the program itself.

#include "support/program/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Two blocks of a town of about 400 m, one street of them oneway.
const std::string town = R"(<osm version="0.6">
<node id="1" lat="48.4000000" lon="15.6000000"/>
<node id="2" lat="48.4000000" lon="15.6054000"/>
<node id="3" lat="48.4000000" lon="15.6108000"/>
<node id="4" lat="48.4036000" lon="15.6000000"/>
<node id="5" lat="48.4036000" lon="15.6054000"/>
<node id="6" lat="48.4036000" lon="15.6108000"/>
<way id="11"><nd ref="1"/><nd ref="2"/><nd ref="3"/><tag k="highway" v="primary"/><tag k="name" v="Ring"/></way>
<way id="12"><nd ref="4"/><nd ref="5"/><nd ref="6"/><tag k="highway" v="primary"/></way>
<way id="13"><nd ref="1"/><nd ref="4"/><tag k="highway" v="residential"/></way>
<way id="14"><nd ref="2"/><nd ref="5"/><tag k="highway" v="residential"/><tag k="oneway" v="yes"/></way>
<way id="15"><nd ref="3"/><nd ref="6"/><tag k="highway" v="residential"/></way>
</osm>
)";

const std::string recipe = R"([trips]
count = 3
length_km = [1.2, 1.4]
stop_share = 0
[[car]]
id = "one"
[[car]]
id = "two"
)";

class Simulate : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        write_file(folder_ / "town.osm", town);
        write_file(folder_ / "recipe.toml", recipe);
    }

    std::string at(const char* name) const { return (folder_ / name).string(); }

    testing::Run simulate(const char* to, std::vector<std::string> more = {}) const {
        std::vector<std::string> words{
            "simulate", "-o", at(to), "--network", at("town.osm"), "--recipe", at("recipe.toml")};
        words.insert(words.end(), more.begin(), more.end());
        return run_macadam(words);
    }

    /// Names below the folder, and what is in the files.
    std::map<std::string, std::string> files_in(const char* name) const {
        std::map<std::string, std::string> files;
        for (const auto& entry : fs::recursive_directory_iterator{folder_ / name}) {
            if (entry.is_regular_file()) {
                files[fs::relative(entry.path(), folder_ / name).string()] =
                    read_file(entry.path());
            }
        }
        return files;
    }

    fs::path folder_;
};

TEST_F(Simulate, TellsTheTruePotholesOfTheRecipe) {
    const std::string header = "way_id,direction,at_m,length_m,depth_mm,track\n";
    write_file(folder_ / "recipe.toml", recipe + "[[road]]\npotholes_per_km = 0\n");
    ASSERT_EQ(simulate("plain").exit_status, 0);
    EXPECT_EQ(read_file(folder_ / "plain/truth-potholes.csv"), header);

    write_file(folder_ / "recipe.toml", recipe + "[[road]]\npotholes_per_km = 20\n");
    ASSERT_EQ(simulate("holes").exit_status, 0);
    const auto truth = read_file(folder_ / "holes/truth-potholes.csv");
    EXPECT_THAT(truth, StartsWith(header));
    std::istringstream rows{truth.substr(header.size())};
    std::size_t count = 0;
    for (std::string row; std::getline(rows, row); ++count) {
        double at_m = 0, length_m = 0, depth_mm = 0;
        char direction[16], track[8];
        long way = 0;
        ASSERT_EQ(std::sscanf(row.c_str(),
                              "%ld,%15[a-z],%lf,%lf,%lf,%7[a-z]",
                              &way,
                              direction,
                              &at_m,
                              &length_m,
                              &depth_mm,
                              track),
                  6)
            << row;
        EXPECT_TRUE(way >= 11 && way <= 15) << row;
        EXPECT_TRUE(at_m > 0 && at_m < 900) << row;
        EXPECT_TRUE(depth_mm >= 0 && depth_mm <= 60) << row;
    }
    EXPECT_GT(count, 80U); // 20 a kilometre on 5.4 km of lanes
}

TEST_F(Simulate, LeavesTripsVehiclesNetworkAndTruth) {
    const auto run = simulate("fleet");
    ASSERT_EQ(run.exit_status, 0) << run.err;
    std::vector<std::string> names;
    for (const auto& [name, content] : files_in("fleet")) {
        names.push_back(name);
    }
    EXPECT_THAT(names,
                ElementsAre("network.osm.pbf",
                            "trips/one-0001.trip.csv.gz",
                            "trips/one-0002.trip.csv.gz",
                            "trips/two-0003.trip.csv.gz",
                            "truth-potholes.csv",
                            "truth-vehicles/one.toml",
                            "truth-vehicles/two.toml",
                            "truth.csv",
                            "vehicles/one.toml",
                            "vehicles/two.toml"));
    EXPECT_THAT(read_file(folder_ / "fleet" / "truth.csv"),
                StartsWith("segment,way_id,direction,from_m,to_m,iri_left,iri_right,mri,hri\n"
                           "11+0000,11,forward,0.000,"));
}

TEST_F(Simulate, GivesTheSameBytesWhateverTheThreads) {
    ASSERT_EQ(simulate("a").exit_status, 0);
    ASSERT_EQ(simulate("b", {"--jobs", "2"}).exit_status, 0);
    EXPECT_EQ(files_in("a"), files_in("b"));
}

TEST_F(Simulate, GivesOtherTripsForAnotherSeed) {
    ASSERT_EQ(simulate("a", {"--trips", "1"}).exit_status, 0);
    ASSERT_EQ(simulate("b", {"--trips", "1", "--seed", "2"}).exit_status, 0);
    const auto first = files_in("a");
    const auto second = files_in("b");
    EXPECT_NE(first.at("trips/one-0001.trip.csv.gz"), second.at("trips/one-0001.trip.csv.gz"));
    EXPECT_NE(first.at("truth.csv"), second.at("truth.csv"));
    EXPECT_EQ(first.at("network.osm.pbf"), second.at("network.osm.pbf"));
}

TEST_F(Simulate, IsFoundAgainByAnImport) {
    ASSERT_EQ(simulate("fleet").exit_status, 0);
    const auto store = at("roads.gpkg");
    ASSERT_EQ(run_macadam({"init", store, "--network", at("fleet/network.osm.pbf")}).exit_status,
              0);
    const auto import = run_macadam(
        {"import", store, at("fleet/trips"), "--channels", "vertical", "--method", "kf"});
    ASSERT_EQ(import.exit_status, 0) << import.err;
    const auto info = run_macadam({"info", store, "--truth", at("fleet/truth.csv")});
    EXPECT_EQ(info.exit_status, 0) << info.err;
    EXPECT_THAT(info.out, HasSubstr("against truth"));
    EXPECT_THAT(info.out, HasSubstr("\nprimary"));
    const auto json = run_macadam({"info", store, "--json", "--truth", at("fleet/truth.csv")});
    EXPECT_THAT(json.out, HasSubstr("\"truth\":{\"all\":{\"segments\":"));
    EXPECT_THAT(json.out, HasSubstr("\"rmse_100m\":"));
}

/// Cells of a table, but for its header.
std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines{csv};
    for (std::string line; std::getline(lines, line);) {
        std::istringstream cells{line};
        rows.emplace_back();
        for (std::string cell; std::getline(cells, cell, ',');) {
            rows.back().push_back(cell);
        }
    }
    rows.erase(rows.begin());
    return rows;
}

/// The number behind the first "NAME": of a JSON text.
double number_in(const std::string& json, const std::string& name) {
    return std::stod(json.substr(json.find("\"" + name + "\":") + name.size() + 3));
}

/// The driven segments as a survey: their middles and true MRI, each way in driving order.
std::string survey_text(const std::string& exported, const std::string& truth) {
    std::map<std::string, std::string> mri;
    for (const auto& row : rows_of(truth)) {
        mri[row[0]] = row[7];
    }
    std::string rows;
    std::string backward; // their segments count against the drive
    for (const auto& row : rows_of(exported)) {
        const bool forward = row[4] == "forward";
        const auto line =
            row[24] + "," + row[25] + "," + row[5] + "," + row[6] + "," + mri.at(row[0]) + "\n";
        rows += forward ? line : "";
        backward = forward ? backward : line + backward;
    }
    return "lat_deg,lon_deg,from_m,to_m,mri\n" + rows + backward;
}

/// By two roads: map matching and the store's segments, and the survey's line. Every trip's passes
/// count here and their mean there, and borders differ by the receiver's error.
TEST_F(Simulate, IsAsNearToItsTruthHeldBesideASurveyAsInAStore) {
    write_file(folder_ / "recipe.toml",
               "[trips]\ncount = 1\nlength_km = [2.4, 2.6]\nstop_share = 0\n[[car]]\nid = "
               "\"one\"\n");
    ASSERT_EQ(simulate("fleet").exit_status, 0);
    const auto store = at("roads.gpkg");
    const auto trip = at("fleet/trips/one-0001.trip.csv.gz");
    const auto truth = at("fleet/truth.csv");
    ASSERT_EQ(run_macadam({"init", store, "--network", at("fleet/network.osm.pbf")}).exit_status,
              0);
    ASSERT_EQ(run_macadam({"import", store, trip, "--method", "kf"}).exit_status, 0);
    ASSERT_EQ(run_macadam({"export", store, "-o", at("segments.csv")}).exit_status, 0);
    const auto info = run_macadam({"info", store, "--json", "--truth", truth}).out;
    write_file(folder_ / "survey.csv",
               survey_text(read_file(folder_ / "segments.csv"), read_file(truth)));
    const auto held =
        run_macadam({"trace", trip, "--method", "kf", "--against", at("survey.csv"), "--json"});
    ASSERT_EQ(held.exit_status, 0) << held.err;
    EXPECT_GT(number_in(held.out, "met"), 0.9 * number_in(held.out, "survey_rows"));
    const auto in_store = info.substr(info.find("\"truth\""));
    EXPECT_NEAR(number_in(held.out, "bias"), number_in(in_store, "bias"), 0.15);
    EXPECT_NEAR(number_in(held.out, "rmse"), number_in(in_store, "rmse_20m"), 0.15);
}

TEST_F(Simulate, TakesANetworkThatIsNotOsm) {
    write_file(folder_ / "ring.geojson",
               R"({"type":"FeatureCollection","features":[
               {"type":"Feature","properties":{},"geometry":{"type":"LineString",
               "coordinates":[[15.6,48.4],[15.61,48.4]]}},
               {"type":"Feature","properties":{},"geometry":{"type":"LineString",
               "coordinates":[[15.61,48.4],[15.61,48.405],[15.6,48.4]]}}]})");
    const auto run = run_macadam({"simulate",
                                  "-o",
                                  at("fleet"),
                                  "--network",
                                  at("ring.geojson"),
                                  "--recipe",
                                  at("recipe.toml"),
                                  "--trips",
                                  "1"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_EQ(
        run_macadam({"init", at("x.gpkg"), "--network", at("fleet/network.osm.pbf")}).exit_status,
        0);
}

TEST_F(Simulate, KeepsOutOfAFolderWithSomethingInIt) {
    fs::create_directory(folder_ / "full");
    write_file(folder_ / "full" / "thesis.txt", "all of it");
    const auto run = simulate("full");
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("full: is not empty, expected a new or an empty folder"));
    EXPECT_EQ(files_in("full").size(), 1U);
}

/// What lies in the test's folder.
std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator{folder}) {
        names.push_back(entry.path().filename().string());
    }
    std::ranges::sort(names);
    return names;
}

TEST_F(Simulate, FillsAFolderThatIsThereAndEmpty) {
    fs::create_directory(folder_ / "fleet");
    ASSERT_EQ(simulate("fleet/", {"--trips", "1"}).exit_status, 0);
    EXPECT_THAT(names_in(folder_ / "fleet"),
                ElementsAre("network.osm.pbf",
                            "trips",
                            "truth-potholes.csv",
                            "truth-vehicles",
                            "truth.csv",
                            "vehicles"));
}

TEST_F(Simulate, LeavesNothingWhenItFails) {
    write_file(folder_ / "oneway.osm",
               R"(<osm version="0.6"><node id="1" lat="48.4" lon="15.6"/>
               <node id="2" lat="48.4" lon="15.61"/><way id="1"><nd ref="1"/><nd ref="2"/>
               <tag k="highway" v="primary"/><tag k="oneway" v="yes"/></way></osm>)");
    const auto run = run_macadam({"simulate", "-o", at("fleet"), "--network", at("oneway.osm")});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("oneway.osm: of 1 roads no two places lead to each other"));
    EXPECT_THAT(names_in(folder_), ElementsAre("oneway.osm", "recipe.toml", "town.osm"));
}

TEST_F(Simulate, LeavesNothingOnAFullDisk) {
    const auto run = run_macadam(
        {"simulate", "-o", at("fleet"), "--network", at("town.osm"), "--recipe", at("recipe.toml")},
        20'000);
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("cannot be written"));
    EXPECT_THAT(names_in(folder_), ElementsAre("recipe.toml", "town.osm"));
}

TEST_F(Simulate, LeavesNothingWhenItIsInterrupted) {
    const auto truth_is_written = [&] {
        for (const auto& entry : fs::recursive_directory_iterator{folder_}) {
            if (entry.path().filename() == "trips") {
                return true;
            }
        }
        return false;
    };
    const auto run = run_macadam_signalled({"simulate",
                                            "-o",
                                            at("fleet"),
                                            "--network",
                                            at("town.osm"),
                                            "--recipe",
                                            at("recipe.toml"),
                                            "--trips",
                                            "1000"},
                                           truth_is_written,
                                           SIGINT);
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("macadam simulate: interrupted: nothing was written"));
    EXPECT_THAT(names_in(folder_), ElementsAre("recipe.toml", "town.osm"));
}

TEST_F(Simulate, NamesWhatAKilledRunLeftInAFolder) {
    fs::create_directories(folder_ / "fleet" / ".part-123");
    const auto run = simulate("fleet");
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("fleet/.part-123: is left behind by an interrupted run"));
}

TEST_F(Simulate, NamesTheWayThatOsmCannotHold) {
    write_file(
        folder_ / "long.geojson",
        R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"name":")" +
            std::string(3000, 'x') +
            R"("},"geometry":{"type":"LineString","coordinates":[[15.6,48.4],[15.61,48.4]]}}]})");
    const auto run = run_macadam({"simulate", "-o", at("fleet"), "--network", at("long.geojson")});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(
        run.err,
        HasSubstr("long.geojson: the name of way '0' has 3000 bytes, expected at most 1024"));
}

TEST_F(Simulate, WarnsOfWhatTheRecipeSaysOfRoadsThatAreNotThere) {
    write_file(folder_ / "recipe.toml",
               recipe + "[speed_kmh]\nresidental = 30\nmotorway = 100\n"
                        "[[road]]\nhighway = \"motorwya\"\n[[road]]\nway_id = 1\n"
                        "[[road]]\nway_id = 11\nname = \"Ring\"\n");
    const auto run = simulate("fleet", {"--trips", "1", "--quiet"});
    EXPECT_EQ(run.exit_status, 0);
    for (const auto* words : {"class 'residental'", "class 'motorwya'", "the way_id '1'"}) {
        EXPECT_THAT(run.err, HasSubstr("recipe.toml: no road has the "));
        EXPECT_THAT(run.err, HasSubstr(words));
    }
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 3);
}

TEST_F(Simulate, ShowsARecipeThatItTakes) {
    const auto shown = run_macadam({"simulate", "--show-recipe"});
    EXPECT_EQ(shown.exit_status, 0);
    write_file(folder_ / "recipe.toml", shown.out);
    EXPECT_EQ(simulate("fleet", {"--trips", "1", "--quiet"}).err, "");
}

TEST_F(Simulate, SaysWhatIsMissingOrWrong) {
    EXPECT_EQ(run_macadam({"simulate"}).exit_status, 2);
    EXPECT_THAT(run_macadam({"simulate", "-o", at("x")}).err,
                HasSubstr("--network FILE is missing"));
    EXPECT_THAT(simulate("x", {"--trips", "0"}).err,
                HasSubstr("--trips is 0, expected 1 to 1000000"));
    EXPECT_THAT(simulate("x", {"--jobs", "0"}).err, HasSubstr("--jobs is 0, expected 1 to 256"));
    write_file(folder_ / "recipe.toml", "[trips]\ncount = 0\n");
    const auto run = simulate("x");
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("recipe.toml:2: 'trips.count' is '0'"));
    EXPECT_FALSE(fs::exists(folder_ / "x"));
}

TEST_F(Simulate, TruthOfOtherRoadsIsRefused) {
    ASSERT_EQ(simulate("fleet", {"--trips", "1"}).exit_status, 0);
    const auto store = at("roads.gpkg");
    ASSERT_EQ(run_macadam({"init", store, "--network", at("town.osm")}).exit_status, 0);
    ASSERT_EQ(run_macadam({"import", store, at("fleet/trips"), "--method", "kf"}).exit_status, 0);
    write_file(folder_ / "truth.csv",
               "segment,way_id,direction,from_m,to_m,iri_left,iri_right,mri,hri\n"
               "99+0000,99,forward,0,20,1,1,1,1\n");
    const auto run = run_macadam({"info", store, "--truth", at("truth.csv")});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("expected true values of this network"));
}

} // namespace
} // namespace macadam::testing
