// Road databases made from maps: which part of them, and which maps are refused.

#include "storage/networks/network_reader.hpp"
#include "storage/store/reader/store_background.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "support/program/places.hpp"
#include "support/program/program.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string krems = source_folder() + "/sample_data/fleet/network.osm.pbf";

/// A track of 11 m a second between two positions.
std::string gpx_between(const GeoPoint& from, const GeoPoint& to) {
    std::string text =
        "<gpx version=\"1.1\" xmlns=\"http://www.topografix.com/GPX/1/1\"><trk><trkseg>";
    const auto count = static_cast<int>(distance_m(from, to) / 11);
    for (int i = 0; i <= count; ++i) {
        const auto at = between(from, to, static_cast<double>(i) / count);
        text += fmt::format(
            "<trkpt lat=\"{:.6f}\" lon=\"{:.6f}\"><time>2026-05-01T08:{:02}:{:02}Z</time></trkpt>",
            at.lat_deg,
            at.lon_deg,
            i / 60,
            i % 60);
    }
    return text + "</trkseg></trk></gpx>";
}

/// A track of 300 m to the north.
std::string gpx_at(double lat_deg, double lon_deg) {
    return gpx_between({lat_deg, lon_deg}, {lat_deg + 0.003, lon_deg});
}

/// The longest straight step of a road of Krems.
std::pair<GeoPoint, GeoPoint> straight_road() {
    std::pair<GeoPoint, GeoPoint> longest{};
    for (const auto& way : read_network(krems)) {
        for (std::size_t i = 1; i < way.line.size(); ++i) {
            if (distance_m(way.line[i - 1], way.line[i]) >
                distance_m(longest.first, longest.second)) {
                longest = {way.line[i - 1], way.line[i]};
            }
        }
    }
    return longest;
}

std::string osm_of_way(const std::string& tags) {
    return "<osm version='0.6'><node id='1' version='1' lat='48.1' lon='16.1'/>"
           "<node id='2' version='1' lat='48.101' lon='16.1'/>"
           "<way id='7' version='1'><nd ref='1'/><nd ref='2'/>" +
           tags + "</way></osm>";
}

class Init : public ::testing::Test {
protected:
    std::string at(const std::string& name) const { return (folder_ / name).string(); }

    macadam::testing::Run init(const std::vector<std::string>& more) const {
        std::vector<std::string> words{"init", store_};
        words.insert(words.end(), more.begin(), more.end());
        return run_macadam(words);
    }

    /// Expects a refusal that leaves nothing behind, and returns its words.
    std::string refusal(const std::vector<std::string>& more, int exit_status = 1) const {
        const auto files = [&] {
            return std::distance(fs::directory_iterator{folder_}, fs::directory_iterator{});
        };
        const auto before = files();
        const auto run = init(more);
        EXPECT_EQ(run.exit_status, exit_status) << run.err;
        EXPECT_EQ(files(), before);
        return run.err;
    }

    fs::path folder_ = fresh_folder();
    std::string store_ = (folder_ / "roads.gpkg").string();
};

TEST_F(Init, TakesOnlyTheRoadsAroundTripsAndSaysHowMany) {
    fs::create_directory(at("trips"));
    const auto [from, to] = straight_road();
    write_file(at("trips/a.gpx"), gpx_between(from, to));
    write_file(at("trips/b.gpx"), gpx_between(to, from));
    write_file(at("trips/readme.txt"), "no trip");
    const auto cut = init({"--network", krems, "--around", at("trips")});
    EXPECT_EQ(cut.exit_status, 0) << cut.err;
    EXPECT_THAT(cut.err,
                ContainsRegex("network.osm.pbf: [0-9]+ of [0-9]+ roads taken, those "
                              "within 1 km of 2 trips"));
    const auto match = run_macadam({"match", at("trips/a.gpx"), "--network", store_});
    EXPECT_THAT(match.out, HasSubstr(",road,"));
}

TEST_F(Init, GoesOnWithoutATripThatCannotBeReadAndNamesIt) {
    write_file(at("a.gpx"), gpx_at(48.410, 15.610));
    write_file(at("b.gpx"), "<gpx");
    const auto cut = init({"--network", krems, "--around", at("a.gpx"), at("b.gpx")});
    EXPECT_EQ(cut.exit_status, 0) << cut.err;
    EXPECT_THAT(cut.err, AllOf(HasSubstr("warning: " + at("b.gpx")), HasSubstr("1 trip")));
}

TEST_F(Init, SaysThatAMapIsOfAnotherRegion) {
    write_file(at("a.gpx"), gpx_at(47.69, 17.63));
    EXPECT_THAT(refusal({"--network", krems, "--around", at("a.gpx")}),
                AllOf(HasSubstr("no road of this map is within 1 km of 1 trip: trips near 47.69, "
                                "17.63; map covers latitude 48."),
                      HasSubstr("expected an extract of the region of the trips"),
                      Not(HasSubstr("exchanged"))));
}

TEST_F(Init, AsksWhetherCoordinatesAreExchanged) {
    write_file(at("a.gpx"), gpx_at(15.610, 48.410));
    EXPECT_THAT(refusal({"--network", krems, "--around", at("a.gpx")}),
                HasSubstr("are latitude and longitude exchanged in the trips or in the map?"));
}

TEST_F(Init, RefusesTripsWithoutPositions) {
    write_file(at("a.gpx"), "<gpx version=\"1.1\"></gpx>");
    EXPECT_THAT(refusal({"--network", krems, "--around", at("a.gpx")}),
                HasSubstr("a.gpx: contains no position, expected trips"));
    EXPECT_THAT(refusal({"--trace", at("a.gpx"), "--around", at("a.gpx")}, 2),
                HasSubstr("--around cannot be combined with --trace"));
}

TEST_F(Init, RefusesToUpdateFromTheRoadsNearTripsOnly) {
    write_file(at("a.gpx"), gpx_at(48.410, 15.610));
    EXPECT_THAT(refusal({"--update", krems, "--around", at("a.gpx")}, 2),
                HasSubstr("--around cannot be combined with --update: roads away from these trips "
                          "would be removed with their passes"));
}

/// A road beside a forest.
std::string osm_with_forest() {
    return "<osm version='0.6'><node id='1' version='1' lat='48.1' lon='16.1'/>"
           "<node id='2' version='1' lat='48.101' lon='16.1'/>"
           "<node id='3' version='1' lat='48.101' lon='16.102'/>"
           "<node id='4' version='1' lat='48.102' lon='16.1'>"
           "<tag k='place' v='village'/><tag k='name' v='Waldau'/></node>"
           "<way id='7' version='1'><nd ref='1'/><nd ref='2'/><tag k='highway' v='primary'/></way>"
           "<way id='8' version='1'><nd ref='1'/><nd ref='2'/><nd ref='3'/><nd ref='1'/>"
           "<tag k='landuse' v='forest'/></way></osm>";
}

TEST_F(Init, StoresWhatLiesBelowTheRoadsAndSaysHowMuchThatIs) {
    write_file(at("town.osm"), osm_with_forest());
    const auto made = init({"--network", at("town.osm")});
    ASSERT_EQ(made.exit_status, 0) << made.err;
    EXPECT_THAT(made.err,
                ContainsRegex("roads.gpkg: background of 0.0 MB with 1 name, read in [0-9.]+ s"));
    // Of three levels: the forest is too small for that of the smallest scales.
    EXPECT_EQ(StoreBackground{StoreReader::open(store_)}.size().tiles, 2);
    const auto removed =
        run_macadam({"init", store_, "--update", at("town.osm"), "--no-background"});
    EXPECT_EQ(removed.exit_status, 0) << removed.err;
    EXPECT_TRUE(StoreBackground{StoreReader::open(store_)}.size().is_empty());
    run_macadam({"init", store_, "--update", at("town.osm")}); // as an upgraded database gets one
    EXPECT_EQ(StoreBackground{StoreReader::open(store_)}.size().tiles, 2);
}

TEST_F(Init, LeavesTheBackgroundOutOnDemandAndTellsThatOtherMapsHaveNone) {
    write_file(at("town.osm"), osm_with_forest());
    const auto without = init({"--network", at("town.osm"), "--no-background"});
    EXPECT_EQ(without.exit_status, 0) << without.err;
    EXPECT_THAT(without.err, Not(HasSubstr("background")));
    EXPECT_TRUE(StoreBackground{StoreReader::open(store_)}.size().is_empty());
    write_file(at("lines.geojson"),
               R"({"type":"Feature","properties":{},"geometry":{"type":"LineString",)"
               R"("coordinates":[[16.1,48.1],[16.1,48.101]]}})");
    const auto other = run_macadam({"init", at("b.gpkg"), "--network", at("lines.geojson")});
    EXPECT_EQ(other.exit_status, 0) << other.err;
    EXPECT_THAT(other.err,
                HasSubstr("lines.geojson: without water, green, buildings and names of places, "
                          "which only maps of OpenStreetMap give"));
    write_file(at("a.gpx"), gpx_at(48.410, 15.610));
    EXPECT_THAT(refusal({"--trace", at("a.gpx"), "--no-background"}, 2),
                HasSubstr("--no-background cannot be combined with --trace"));
}

TEST_F(Init, RefusesAMapWithoutRoadsAndSaysWhatIsThere) {
    write_file(at("paths.osm"), osm_of_way("<tag k='highway' v='footway'/>"));
    EXPECT_THAT(refusal({"--network", at("paths.osm")}),
                HasSubstr("paths.osm: contains no drivable road: its ways are not open to cars "
                          "(highway = 'footway')"));
    write_file(at("houses.osm"), osm_of_way("<tag k='building' v='yes'/>"));
    EXPECT_THAT(refusal({"--network", at("houses.osm")}),
                HasSubstr("houses.osm: contains no drivable road: no way has a highway tag"));
    write_file(at("ways.osm"),
               "<osm version='0.6'><way id='7' version='1'><nd ref='1'/><nd ref='2'/>"
               "<tag k='highway' v='primary'/></way></osm>");
    EXPECT_THAT(refusal({"--network", at("ways.osm")}),
                HasSubstr("the positions of the points of its 1 way are missing"));
}

TEST_F(Init, WithoutAMapNamesWhereToGetOne) {
    EXPECT_THAT(refusal({}, 2), HasSubstr("where to get a FILE of roads: macadam help init"));
    const auto help = run_macadam({"init", "--help"}).out;
    for (const auto* const place :
         {"download.geofabrik.de", "extract.bbbike.org", "www.openstreetmap.org/export", "ODbL"}) {
        EXPECT_THAT(help, HasSubstr(place));
    }
}

TEST_F(Init, MakesADatabaseThatRefusesClassesOfRoadsThatDoNotExist) {
    write_file(at("road.osm"), osm_of_way("<tag k='highway' v='residential'/>"));
    init({"--network", at("road.osm")});
    const auto query = [&](const std::string& highway) {
        return run_macadam({"query", store_, "--all", "--highway", highway, "--format", "csv"});
    };
    EXPECT_THAT(query("residential").out, HasSubstr("\n7+0000,"));
    EXPECT_EQ(query("motorway").exit_status, 0); // a class of OSM, of which this map has none
    const auto refused = query("residental");
    EXPECT_EQ(refused.exit_status, 2);
    EXPECT_THAT(refused.err,
                HasSubstr("--highway is 'residental', expected residential; did you mean "
                          "residential?"));
}

TEST_F(Init, TakesALimitOfTheTripsThatAreFusedOnceAndForAll) {
    write_file(at("road.osm"), osm_of_way("<tag k='highway' v='residential'/>"));
    EXPECT_THAT(refusal({"--network", at("road.osm"), "--max-trips-per-car-month", "0"}, 2),
                HasSubstr("--max-trips-per-car-month is 0, expected 1 to 1000"));
    init({"--network", at("road.osm"), "--max-trips-per-car-month", "3"});
    EXPECT_THAT(run_macadam({"info", store_}).out,
                HasSubstr("fused       at most 3 trips of a car over a segment in a month\n"));
    EXPECT_THAT(refusal({"--update", at("road.osm"), "--max-trips-per-car-month", "4"}, 2),
                HasSubstr("--max-trips-per-car-month cannot be changed by --update"));
}

} // namespace
} // namespace macadam::testing
