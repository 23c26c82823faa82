#include "storage/networks/network_reader.hpp"

#include "support/files/compressed.hpp"
#include "support/files/files.hpp"
#include "support/program/places.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

using namespace macadam;
using namespace macadam::testing;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

namespace {

const std::string harrisburg = source_folder() + "/tests/data/osm/harrisburg.osm.pbf";

/// An OSM file of three nodes in a row and one way over them, with those tags.
std::string osm_of(const std::string& tags) {
    return "<osm version='0.6'>"
           "<node id='11' version='1' lat='48.1' lon='16.1'/>"
           "<node id='12' version='1' lat='48.2' lon='16.2'/>"
           "<node id='13' version='1' lat='48.3' lon='16.3'/>"
           "<way id='7' version='1'><nd ref='11'/><nd ref='12'/><nd ref='13'/>" +
           tags + "</way></osm>";
}

std::string tag(const std::string& key, const std::string& value) {
    return "<tag k='" + key + "' v='" + value + "'/>";
}

std::vector<Way> read_osm_of(const std::string& tags) {
    return read_network(written(test_folder(), "a.osm", osm_of(tags)));
}

Oneway oneway_with(const std::string& tags) {
    return read_osm_of(tag("highway", "primary") + tags).at(0).oneway;
}

bool drivable_with(const std::string& tags) {
    return refusal_of([&] { read_osm_of(tags); }).empty();
}

/// A GeoJSON file of features, each {"properties"}, {"geometry"}.
std::string geojson_of(const std::vector<std::pair<std::string, std::string>>& features,
                       const std::string& crs = "") {
    std::string text = R"({"type":"FeatureCollection",)";
    if (!crs.empty()) {
        text += R"("crs":{"type":"name","properties":{"name":")" + crs + R"("}},)";
    }
    text += R"("features":[)";
    for (const auto& [properties, geometry] : features) {
        text += (text.back() == '[' ? "" : ",") +
                std::string{R"({"type":"Feature","properties":)"} + properties + R"(,"geometry":)" +
                geometry + "}";
    }
    return text + "]}";
}

std::string line(const std::string& coordinates) {
    return R"({"type":"LineString","coordinates":[)" + coordinates + "]}";
}

std::vector<Way> read_geojson(const std::string& text, const LayerColumns& columns = {}) {
    return read_network(written(test_folder(), "a.geojson", text), columns);
}

std::string content_of(const std::string& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

/// Way 1 from node 11 to 12 and ways 2, 3 on from there, with one relation over node 12: from way 1
/// to way 2, with those tags and further members.
std::vector<TurnRule>
turns_with(const std::string& tags,
           const std::string& members = "<member type='node' ref='12' role='via'/>") {
    const auto way = [](int id, int from, int to) {
        return fmt::format("<way id='{}' version='1'><nd ref='{}'/><nd ref='{}'/>{}</way>",
                           id,
                           from,
                           to,
                           tag("highway", "primary"));
    };
    const auto file = written(
        test_folder(),
        "a.osm",
        "<osm version='0.6'>"
        "<node id='11' version='1' lat='48.1' lon='16.1'/>"
        "<node id='12' version='1' lat='48.2' lon='16.2'/>"
        "<node id='13' version='1' lat='48.3' lon='16.3'/>"
        "<node id='14' version='1' lat='48.2' lon='16.3'/>" +
            way(1, 11, 12) + way(2, 12, 13) + way(3, 12, 14) +
            "<relation id='5' version='1'><member type='way' ref='1' role='from'/>" + members +
            "<member type='way' ref='2' role='to'/>" + tags + "</relation></osm>");
    const auto ways = read_network(file);
    EXPECT_THAT(ways.at(1).turns, IsEmpty());
    EXPECT_THAT(ways.at(2).turns, IsEmpty());
    return ways.at(0).turns;
}

const std::string restriction = tag("type", "restriction");

} // namespace

TEST(NetworkReader, ReadsTheWaysAroundPositionsAsTheyAreInTheWholeMap) {
    const auto all = read_network(harrisburg);
    const auto centre = all.front().line.front();
    Surroundings around{300};
    around.add(centre);
    NetworkCut cut{.around = around};
    const auto ways = read_network(harrisburg, {}, {}, {}, &cut);
    EXPECT_EQ(cut.ways, all.size());
    EXPECT_FALSE(cut.holds_exchanged);
    EXPECT_TRUE(contains(cut.extent, centre));
    std::vector<Way> near;
    std::copy_if(all.begin(), all.end(), std::back_inserter(near), [&](const Way& way) {
        return std::any_of(way.line.begin(), way.line.end(), [&](const GeoPoint& point) {
            return around.contains(point);
        });
    });
    EXPECT_GT(near.size(), 3U);
    EXPECT_LT(near.size(), all.size() / 2);
    ASSERT_EQ(ways.size(), near.size());
    for (std::size_t i = 0; i < ways.size(); ++i) {
        EXPECT_EQ(ways[i].id, near[i].id);
        EXPECT_EQ(ways[i].node_ids, near[i].node_ids);
        EXPECT_EQ(ways[i].line, near[i].line);
        EXPECT_EQ(ways[i].turns, near[i].turns);
    }
}

TEST(NetworkReader, ReadsTheLinesOfALayerAroundPositions) {
    const auto file = written(test_folder(),
                              "a.geojson",
                              geojson_of({{"{}", line("[16.1,48.1],[16.2,48.2]")},
                                          {"{}", line("[17.1,48.1],[17.2,48.2]")}}));
    Surroundings around{1000};
    around.add({48.2, 17.2});
    NetworkCut cut{.around = around};
    const auto ways = read_network(file, {}, {}, {}, &cut);
    ASSERT_EQ(ways.size(), 1U);
    EXPECT_EQ(ways[0].line[1], (GeoPoint{48.2, 17.2}));
    EXPECT_EQ(ways[0].node_ids, (std::vector<std::int64_t>{3, 4}));
    EXPECT_EQ(cut.ways, 2U);
}

TEST(NetworkReader, FindsNoWayAroundPositionsElsewhereAndSeesExchangedOnes) {
    Surroundings around{1000};
    around.add({16.2, 48.2});
    NetworkCut cut{.around = around};
    const auto file = written(test_folder(), "a.osm", osm_of(tag("highway", "primary")));
    EXPECT_THAT(read_network(file, {}, {}, {}, &cut), IsEmpty());
    EXPECT_EQ(cut.ways, 1U);
    EXPECT_TRUE(cut.holds_exchanged);
}

TEST(NetworkReader, ReadsTheDrivableWaysOfARealMap) {
    const auto ways = read_network(harrisburg);
    const auto with = [&](Oneway oneway) {
        return std::count_if(
            ways.begin(), ways.end(), [&](const Way& way) { return way.oneway == oneway; });
    };
    // Counted from the map's text form by a script of its own: 2514 ways less 19 footways, a path,
    // a track of no grade, 17 private service roads and one of a single node.
    EXPECT_EQ(ways.size(), 2475U);
    EXPECT_EQ(with(Oneway::forward), 385);
    EXPECT_EQ(with(Oneway::backward), 3);
    for (const auto& way : ways) {
        EXPECT_NE(way.highway, "footway");
        EXPECT_EQ(way.node_ids.size(), way.line.size());
        EXPECT_GE(way.line.size(), 2U);
    }
    EXPECT_TRUE(std::is_sorted(
        ways.begin(), ways.end(), [](const Way& a, const Way& b) { return a.id < b.id; }));
}

TEST(NetworkReader, KeepsIdsNamesAndPlacesOfAnOsmWay) {
    const auto ways = read_osm_of(tag("highway", "residential") + tag("name", "Am Hof"));
    ASSERT_EQ(ways.size(), 1U);
    EXPECT_EQ(ways[0].id, 7);
    EXPECT_EQ(ways[0].name, "Am Hof");
    EXPECT_EQ(ways[0].highway, "residential");
    EXPECT_THAT(ways[0].node_ids, ElementsAre(11, 12, 13));
    EXPECT_THAT(ways[0].line,
                ElementsAre(GeoPoint{48.1, 16.1}, GeoPoint{48.2, 16.2}, GeoPoint{48.3, 16.3}));
}

TEST(NetworkReader, ReadsEachSpellingOfASpeedLimit) {
    const auto limit_with = [](const std::string& tags) {
        return read_osm_of(tag("highway", "primary") + tags).at(0).speed_limit_cmps;
    };
    EXPECT_EQ(limit_with(""), 0);
    EXPECT_EQ(limit_with(tag("maxspeed", "50")), 1389); // 50 / 3.6 = 13.889 m/s
    EXPECT_EQ(limit_with(tag("maxspeed", "50 km/h")), 1389);
    EXPECT_EQ(limit_with(tag("maxspeed", "30 mph")), 1341); // 30 * 0.44704 m/s
    EXPECT_EQ(limit_with(tag("maxspeed", "none")), 6944);
    EXPECT_EQ(limit_with(tag("maxspeed", "walk")), 194);
    EXPECT_EQ(limit_with(tag("maxspeed:forward", "50") + tag("maxspeed:backward", "70")), 1944);
    for (const auto* const other : {"signals", "DE:urban", "0", "-5", "1000", "50; 30", "mph"}) {
        EXPECT_EQ(limit_with(tag("maxspeed", other)), 0) << other;
    }
}

TEST(NetworkReader, ReadsEachSpellingOfATurnRestriction) {
    for (const std::string value : {"left_turn", "right_turn", "straight_on", "u_turn"}) {
        EXPECT_THAT(turns_with(restriction + tag("restriction", "no_" + value)),
                    ElementsAre(TurnRule{12, 2, 0}));
        EXPECT_THAT(turns_with(restriction + tag("restriction", "only_" + value)),
                    ElementsAre(TurnRule{12, 2, 1}));
    }
    EXPECT_THAT(turns_with(restriction + tag("restriction", "no_entry")),
                ElementsAre(TurnRule{12, 2, 0}));
    EXPECT_THAT(turns_with(restriction + tag("restriction:motorcar", "no_left_turn")),
                ElementsAre(TurnRule{12, 2, 0}));
    EXPECT_THAT(
        turns_with(restriction + tag("restriction", "no_left_turn") + tag("except", "bicycle;psv")),
        ElementsAre(TurnRule{12, 2, 0}));
}

TEST(NetworkReader, PassesOverTurnRestrictionsThatAreNotForCarsAtAllHours) {
    const auto left = tag("restriction", "no_left_turn");
    for (const auto& tags : {left,
                             tag("type", "route") + left,
                             restriction + tag("restriction", "no_hope"),
                             restriction + tag("restriction:hgv", "no_left_turn"),
                             restriction + tag("restriction:conditional", "no_left_turn @ (Su)"),
                             restriction + left + tag("except", "psv; motorcar"),
                             restriction + left + tag("hour_on", "07:00")}) {
        EXPECT_THAT(turns_with(tags), IsEmpty()) << tags;
    }
}

TEST(NetworkReader, PassesOverTurnRestrictionsThatAreNotOverOneNode) {
    const auto tags = restriction + tag("restriction", "no_left_turn");
    EXPECT_THAT(turns_with(tags, ""), IsEmpty());
    EXPECT_THAT(turns_with(tags, "<member type='way' ref='3' role='via'/>"), IsEmpty());
    EXPECT_THAT(turns_with(tags,
                           "<member type='node' ref='12' role='via'/>"
                           "<member type='node' ref='13' role='via'/>"),
                IsEmpty());
}

TEST(NetworkReader, NamesARoadByItsNumberIfItHasNoName) {
    EXPECT_EQ(read_osm_of(tag("highway", "primary") + tag("ref", "B1")).at(0).name, "B1");
}

TEST(NetworkReader, ReadsEachSpellingOfOneway) {
    for (const auto* const value : {"yes", "1", "true"}) {
        EXPECT_EQ(oneway_with(tag("oneway", value)), Oneway::forward) << value;
    }
    for (const auto* const value : {"-1", "reverse"}) {
        EXPECT_EQ(oneway_with(tag("oneway", value)), Oneway::backward) << value;
    }
    for (const auto* const value : {"no", "reversible"}) {
        EXPECT_EQ(oneway_with(tag("oneway", value)), Oneway::no) << value;
    }
    EXPECT_EQ(oneway_with(""), Oneway::no);
}

TEST(NetworkReader, DrivesRoundaboutsAndMotorwaysOneWayUnlessTheMapSaysOtherwise) {
    EXPECT_EQ(oneway_with(tag("junction", "roundabout")), Oneway::forward);
    EXPECT_EQ(oneway_with(tag("junction", "circular")), Oneway::forward);
    EXPECT_EQ(oneway_with(tag("junction", "roundabout") + tag("oneway", "no")), Oneway::no);
    EXPECT_EQ(read_osm_of(tag("highway", "motorway")).at(0).oneway, Oneway::forward);
}

TEST(NetworkReader, LeavesOutWhereNoCarMayDrive) {
    EXPECT_FALSE(drivable_with(tag("highway", "footway")));
    EXPECT_FALSE(drivable_with(tag("highway", "track")));
    EXPECT_TRUE(drivable_with(tag("highway", "track") + tag("tracktype", "grade1")));
    EXPECT_FALSE(drivable_with(tag("highway", "service") + tag("area", "yes")));
    EXPECT_FALSE(drivable_with(tag("highway", "primary") + tag("access", "no")));
    EXPECT_FALSE(drivable_with(tag("highway", "primary") + tag("motor_vehicle", "no")));
    EXPECT_TRUE(
        drivable_with(tag("highway", "primary") + tag("access", "no") + tag("motorcar", "yes")));
    EXPECT_FALSE(drivable_with(tag("highway", "service") + tag("access", "private")));
    EXPECT_TRUE(drivable_with(tag("highway", "residential") + tag("access", "private")));
}

TEST(NetworkReader, CutsAWayWhereItsNodesAreMissing) {
    const auto ways = read_network(
        written(test_folder(),
                "a.osm",
                "<osm version='0.6'>"
                "<node id='1' version='1' lat='48.1' lon='16'/>"
                "<node id='3' version='1' lat='48.3' lon='16'/>"
                "<node id='4' version='1' lat='48.4' lon='16'/>"
                "<way id='7' version='1'><nd ref='1'/><nd ref='2'/><nd ref='3'/><nd ref='4'/>"
                "<nd ref='4'/><nd ref='5'/><tag k='highway' v='primary'/></way></osm>"));
    ASSERT_EQ(ways.size(), 1U);
    EXPECT_THAT(ways[0].node_ids, ElementsAre(3, 4));
}

TEST(NetworkReader, FindsNodesThatComeOutOfOrder) {
    const auto ways =
        read_network(written(test_folder(),
                             "a.osm",
                             "<osm version='0.6'>"
                             "<node id='9' version='1' lat='48.9' lon='16'/>"
                             "<node id='2' version='1' lat='48.2' lon='16'/>"
                             "<node id='5' version='1' lat='48.5' lon='16'/>"
                             "<way id='7' version='1'><nd ref='2'/><nd ref='5'/>"
                             "<nd ref='9'/><tag k='highway' v='primary'/></way></osm>"));
    EXPECT_THAT(ways.at(0).line,
                ElementsAre(GeoPoint{48.2, 16}, GeoPoint{48.5, 16}, GeoPoint{48.9, 16}));
}

TEST(NetworkReader, ReadsOsmXmlInGzip) {
    const auto file =
        written(test_folder(), "a.osm.gz", gzipped(osm_of(tag("highway", "primary"))));
    EXPECT_EQ(read_network(file).size(), 1U);
}

TEST(NetworkReader, RefusesAMapThatIsCutOffOrSomethingElse) {
    const auto folder = test_folder();
    const auto pbf = content_of(harrisburg);
    const auto xml = osm_of(tag("highway", "primary"));
    for (const auto& file : {written(folder, "a.osm.pbf", pbf.substr(0, pbf.size() - 1000)),
                             written(folder, "b.osm.pbf", "# macadam-trip 1\n"),
                             written(folder, "c.osm", xml.substr(0, xml.size() - 8)),
                             written(folder, "d.osm.gz", gzipped(xml).substr(0, 100))}) {
        EXPECT_THAT(refusal_of([&] { read_network(file); }),
                    HasSubstr(file.string() + ": cannot be read as an OSM map: "));
    }
}

TEST(NetworkReader, RefusesAMapWithoutRoads) {
    EXPECT_THAT(
        refusal_of([] { read_osm_of(tag("highway", "footway")); }),
        EndsWith("a.osm: contains no drivable road: its ways are not open to cars (highway = "
                 "'footway')"));
    EXPECT_THAT(refusal_of([] { read_network("/nowhere/a.osm.pbf"); }),
                EndsWith("/nowhere/a.osm.pbf: cannot be read: No such file or directory"));
}

TEST(NetworkReader, RefusesNamesThatAreNoFiles) {
    for (const auto* const name :
         {"/vsicurl/x.geojson", "PG:dbname=x", "<OGRVRTDataSource>", "https://x/a.osm"}) {
        EXPECT_THAT(refusal_of([&] { read_network(name); }), HasSubstr("is not a file name"))
            << name;
    }
}

TEST(NetworkReader, MeetsLinesOfALayerWhereTheyShareAVertex) {
    const auto ways = read_geojson(geojson_of({{"{}", line("[16,48],[16.1,48],[16.2,48]")},
                                               {"{}", line("[16.1,48.1],[16.1,48.00000004]")}}));
    ASSERT_EQ(ways.size(), 2U);
    EXPECT_THAT(ways[0].node_ids, ElementsAre(1, 2, 3));
    EXPECT_THAT(ways[1].node_ids, ElementsAre(4, 2));
}

TEST(NetworkReader, MeetsLinesOfALayerWhoseVerticesLieWithinACentimetre) {
    // Ends drawn 0.6e-7 degrees apart, wherever on the grid of 1e-7 that happens to be.
    for (int i = 0; i < 20; ++i) {
        const double lon_deg = 10.01 + i * 0.13e-7;
        const auto ways = read_geojson(geojson_of(
            {{"{}", line(fmt::format("[10, 50], [{:.10f}, 50]", lon_deg))},
             {"{}", line(fmt::format("[{:.10f}, 50.00000006], [10.02, 50]", lon_deg + 0.6e-7))},
             {"{}", line(fmt::format("[{:.10f}, 50], [10.03, 50]", lon_deg + 3e-7))}}));
        ASSERT_EQ(ways.size(), 3U);
        EXPECT_EQ(ways[0].node_ids.back(), ways[1].node_ids.front());
        EXPECT_EQ(ways[0].line.back(), ways[1].line.front());
        EXPECT_NE(ways[0].node_ids.back(), ways[2].node_ids.front());
    }
}

TEST(NetworkReader, FindsTheUsualColumnsOfALayer) {
    const auto way = read_geojson(geojson_of({{R"({"NAME":"Ring","highway":"trunk","Oneway":"T"})",
                                               line("[16,48],[16.1,48]")}}))
                         .at(0);
    EXPECT_EQ(way.name, "Ring");
    EXPECT_EQ(way.highway, "trunk");
    EXPECT_EQ(way.oneway, Oneway::backward);
}

TEST(NetworkReader, TakesTheFirstNameOfAListThatOsmnxWrites) {
    const auto ways = read_geojson(
        geojson_of({{R"({"name":"['Kungsgatan', 'Kungsbron']","highway":"['primary', 'trunk']"})",
                     line("[18,59],[18.1,59]")},
                    {R"({"name":"[Sic] Road","highway":"service"})", line("[18,60],[18.1,60]")}}));
    ASSERT_EQ(ways.size(), 2U);
    EXPECT_EQ(ways[0].name, "Kungsgatan");
    EXPECT_EQ(ways[0].highway, "primary");
    EXPECT_EQ(ways[1].name, "[Sic] Road");
}

TEST(NetworkReader, TakesTheColumnsThatAreNamed) {
    const auto text =
        geojson_of({{R"({"LINK":501,"gata":"Kungsgatan","dir":"FT"})", line("[18,59],[18.1,59]")}});
    const auto way =
        read_geojson(text,
                     {.layer = {}, .id = "LINK", .name = "gata", .highway = {}, .oneway = "dir"})
            .at(0);
    EXPECT_EQ(way.id, 501);
    EXPECT_EQ(way.name, "Kungsgatan");
    EXPECT_EQ(way.oneway, Oneway::forward);
    EXPECT_THAT(refusal_of([&] {
                    read_geojson(
                        text, {.layer = {}, .id = "no", .name = {}, .highway = {}, .oneway = {}});
                }),
                HasSubstr("has no column 'no'"));
}

TEST(NetworkReader, TakesWholeRealsForIds) {
    const LayerColumns by_link{.layer = {}, .id = "link", .name = {}, .highway = {}, .oneway = {}};
    const auto road = line("[16,48],[16.1,48]");
    EXPECT_EQ(read_geojson(geojson_of({{R"({"link":501.0})", road}}), by_link).at(0).id, 501);
    EXPECT_THAT(refusal_of([&] {
                    read_geojson(geojson_of({{R"({"link":501.5})", road}}), by_link);
                }),
                EndsWith("its id is '501.5', expected a whole number"));
}

TEST(NetworkReader, RefusesIdsThatStandTwiceOrAreNoNumbers) {
    const LayerColumns by_link{.layer = {}, .id = "link", .name = {}, .highway = {}, .oneway = {}};
    const auto road = line("[16,48],[16.1,48]");
    EXPECT_THAT(
        refusal_of([&] {
            read_geojson(geojson_of({{R"({"link":5})", road}, {R"({"link":5})", road}}), by_link);
        }),
        EndsWith("the id 5 occurs twice, expected once"));
    EXPECT_THAT(refusal_of([&] {
                    read_geojson(geojson_of({{R"({"link":"E4"})", road}}), by_link);
                }),
                EndsWith("its id is 'E4', expected a whole number"));
}

TEST(NetworkReader, RefusesAOnewayThatItCannotRead) {
    EXPECT_THAT(
        refusal_of([] {
            read_geojson(geojson_of({{R"({"oneway":"maybe"})", line("[16,48],[16.1,48]")}}));
        }),
        HasSubstr("oneway is 'maybe', expected yes, no or -1"));
}

TEST(NetworkReader, MakesAWayOfEachPartOfALine) {
    const auto ways = read_geojson(
        geojson_of(
            {{R"({"link":8})",
              R"({"type":"MultiLineString","coordinates":[[[16,48],[16.1,48]],[[17,48],[17.1,48,200]]]})"}}),
        {.layer = {}, .id = "link", .name = {}, .highway = {}, .oneway = {}});
    ASSERT_EQ(ways.size(), 2U);
    EXPECT_EQ(ways[0].id, 8);
    EXPECT_EQ(ways[1].id, 8 + layer_part_id_step);
    EXPECT_THAT(ways[1].node_ids, ElementsAre(3, 4));
}

TEST(NetworkReader, LeavesFootwaysOfALayerOut) {
    const auto road = line("[16,48],[16.1,48]");
    const auto ways = read_geojson(
        geojson_of({{R"({"fclass":"footway"})", road}, {R"({"fclass":"residential"})", road}}));
    ASSERT_EQ(ways.size(), 1U);
    EXPECT_EQ(ways[0].highway, "residential");
}

TEST(NetworkReader, ConvertsAnyCoordinatesToDegrees) {
    // Web Mercator: x = a lon, y = a ln tan(pi/4 + lat/2), a = 6378137 m.
    const auto way = read_geojson(geojson_of({{"{}", line("[2000000,6000000],[2000100,6000000]")}},
                                             "urn:ogc:def:crs:EPSG::3857"))
                         .at(0);
    constexpr double a = 6378137;
    constexpr double per_rad = 180 / std::numbers::pi;
    EXPECT_NEAR(way.line[0].lon_deg, 2000000 / a * per_rad, 1e-9);
    EXPECT_NEAR(way.line[0].lat_deg,
                (2 * std::atan(std::exp(6000000 / a)) - std::numbers::pi / 2) * per_rad,
                1e-9);
}

TEST(NetworkReader, TakesLongitudeFirstWhateverTheLawOfTheSystem) {
    // EPSG:3006 (SWEREF 99 TM): east 500000 lies on its middle meridian, 15 degrees east.
    const auto way = read_geojson(geojson_of({{"{}", line("[500000,6600000],[500000,6600100]")}},
                                             "urn:ogc:def:crs:EPSG::3006"))
                         .at(0);
    EXPECT_NEAR(way.line[0].lon_deg, 15, 1e-9);
    EXPECT_NEAR(way.line[0].lat_deg, 59.5, 0.1);
}

TEST(NetworkReader, PutsWhatGdalSaysIntoItsOwnMessage) {
    const auto folder = test_folder();
    const auto vrt = written(folder, "a.vrt", "<OGRVRTDataSource></OGRVRTDataSource>");
    const auto broken =
        written(folder, "b.geojson", R"({"type":"FeatureCollection","features":[{)");
    ::testing::internal::CaptureStderr();
    EXPECT_THAT(refusal_of([&] { read_network(vrt); }),
                HasSubstr(vrt.string() + ": cannot be read as a line layer: "));
    EXPECT_THAT(refusal_of([&] { read_network(broken); }), HasSubstr(broken.string() + ": "));
    EXPECT_THAT(::testing::internal::GetCapturedStderr(), IsEmpty());
}

TEST(NetworkReader, NamesTheLayersThereAreIfTheOneAskedForIsNot) {
    EXPECT_THAT(refusal_of([] {
                    read_geojson(
                        geojson_of({{"{}", line("[16,48],[16.1,48]")}}),
                        {.layer = "roads", .id = {}, .name = {}, .highway = {}, .oneway = {}});
                }),
                AllOf(HasSubstr("has no layer 'roads', only 'a'")));
}
