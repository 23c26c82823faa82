// `macadam query`, `export --sections` and `info` as users run them, on a small made-up country.

#include "storage/networks/network_file.hpp"
#include "support/program/road_program.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>

namespace macadam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;
using Json = nlohmann::json;

class QueryProgram : public RoadProgram {
protected:
    void SetUp() override {
        RoadProgram::SetUp();
        const auto store = StoreReader::open(store_);
        cache_network(store, small_country());
        store.visit({}, [&](const SegmentRecord& record) { measured_.push_back(record); });
    }

    macadam::testing::Run query(std::vector<std::string> words) const {
        return run("query", std::move(words));
    }

    Json answer(std::vector<std::string> words) const {
        words.push_back("--json");
        const auto run = query(words);
        EXPECT_EQ(run.exit_status, 0) << run.err;
        return Json::parse(run.out);
    }

    /// "LAT,LON" of a share of way 1.
    static std::string place(double share) {
        const auto way = copy_of(way_at(small_country(), 0));
        const auto at = between(way.line.front(), way.line.back(), share);
        return fmt::format("{:.7f},{:.7f}", at.lat_deg, at.lon_deg);
    }

    std::vector<SegmentRecord> measured_;
};

std::size_t lines_in(const std::string& text) {
    return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

/// Weighted mean of the segments of way 1 that lie between two stations.
double
mean_iri(const std::vector<SegmentRecord>& records, bool forward, double from_m, double to_m) {
    double whole_m = 0, sum = 0;
    for (const auto& [segment, name, highway, state] : records) {
        const double shared_m = std::min(to_m, segment.to_m) - std::max(from_m, segment.from_m);
        if (segment.key.forward == forward && shared_m > 0) {
            whole_m += shared_m;
            sum += shared_m * state->iri_um / 1000;
        }
    }
    return sum / whole_m;
}

TEST_F(QueryProgram, SaysTheSameInEveryFormat) {
    const auto keys = [&](const Json& features, bool geojson) {
        std::vector<std::string> found;
        for (const auto& feature : features) {
            found.push_back(feature.at(geojson ? "id" : "segment"));
        }
        return found;
    };
    const auto json = keys(answer({"--way", "1"}), false);
    EXPECT_THAT(json, SizeIs(20));
    const auto geojson = query({"--way", "1", "--format", "geojson"});
    EXPECT_EQ(keys(Json::parse(geojson.out).at("features"), true), json);
    const auto csv = query({"--way", "1", "--format", "csv"}).out;
    const auto table = query({"--way", "1"}).out;
    EXPECT_EQ(lines_in(csv), 21U);
    EXPECT_EQ(lines_in(table), 21U);
    for (const auto& key : json) {
        EXPECT_THAT(csv, HasSubstr("\n" + key + ","));
        EXPECT_THAT(table, HasSubstr("\n" + key + " "));
    }
}

TEST_F(QueryProgram, FindsNothingInWordsOnStandardErrorAlone) {
    for (const auto& [format, out] : std::vector<std::pair<std::string, std::string>>{
             {"table", ""},
             {"json", "[]\n"},
             {"geojson", "{\"type\":\"FeatureCollection\",\"features\":[]}\n"}}) {
        const auto run = query({"--road", "nowhere", "--format", format});
        EXPECT_EQ(run.exit_status, 0);
        EXPECT_EQ(run.out, out);
        EXPECT_THAT(run.err, HasSubstr("no segment with a pass meets these conditions"));
    }
}

TEST_F(QueryProgram, TellsTheDirectionsOfOneRoadByHeading) {
    for (const auto& [heading, sign] :
         std::vector<std::pair<std::string, char>>{{"90", '+'}, {"270", '-'}, {"60", '+'}}) {
        const auto found = answer({"--near", place(0.33), "--radius", "15", "--heading", heading});
        ASSERT_FALSE(found.empty());
        for (const auto& segment : found) {
            EXPECT_EQ(segment.at("segment").get<std::string>()[1], sign) << heading;
        }
    }
    EXPECT_THAT(answer({"--near", place(0.33), "--radius", "15", "--heading", "0"}), IsEmpty());
}

TEST_F(QueryProgram, TellsHistoryMonthByMonthAsEachMonthIsAsked) {
    const auto months = answer({"--way", "1", "--history"});
    ASSERT_THAT(months, SizeIs(5)); // of six trips one is undated; they are 100 days apart
    for (const auto& month : months) {
        const std::string name = month.at("month");
        const auto segments = answer({"--way", "1", "--since", name, "--until", name});
        EXPECT_EQ(month.at("segments"), segments.size());
        double whole_m = 0, sum = 0;
        for (const auto& segment : segments) {
            const double length_m =
                segment.at("to_m").get<double>() - segment.at("from_m").get<double>();
            whole_m += length_m;
            sum += length_m * segment.at("iri").get<double>();
        }
        EXPECT_NEAR(month.at("iri").get<double>(), sum / whole_m, 0.002); // rounded numbers
        EXPECT_NEAR(month.at("length_m").get<double>(), whole_m, 0.2);
        EXPECT_LT(month.at("iri_low"), month.at("iri"));
        EXPECT_EQ(month.at("passes_least"), 1);
    }
    EXPECT_EQ(lines_in(query({"--way", "1", "--history", "--format", "csv"}).out), 6U);
    EXPECT_EQ(lines_in(query({"--way", "1", "--history"}).out), 6U);
}

TEST_F(QueryProgram, ListsThePassesOfASegment) {
    EXPECT_THAT(answer({"--segment", "1+0003", "--passes"}), SizeIs(6));
    const auto csv = query({"--segment", "1+0003", "--passes", "--format", "csv"}).out;
    EXPECT_EQ(lines_in(csv), 7U);
    EXPECT_THAT(csv, StartsWith("segment,utc,vehicle,iri,"));
}

// ------------------------------------------------------------------------------------- sections

TEST_F(QueryProgram, GivesTheProfileOfARouteInBothDirections) {
    for (const bool forward : {true, false}) {
        const auto sections = answer({"--route",
                                      place(forward ? 0.1 : 0.9),
                                      place(forward ? 0.9 : 0.1),
                                      "--section-length",
                                      "50m"});
        ASSERT_THAT(sections, SizeIs(4)); // 160 m of 200 m
        double at_m = 0;
        for (const auto& section : sections) {
            EXPECT_NEAR(section.at("from_m").get<double>(), at_m, 0.01);
            at_m = section.at("to_m");
            const auto& part = section.at("parts").at(0);
            EXPECT_EQ(part.at("direction"), forward ? "forward" : "backward");
            EXPECT_EQ(section.at("covered"), 1.0);
            EXPECT_NEAR(section.at("iri").get<double>(),
                        mean_iri(measured_, forward, part.at("from_m"), part.at("to_m")),
                        0.002); // places are rounded to centimetres
        }
        EXPECT_NEAR(at_m, 0.8 * 200, 1);
    }
}

TEST_F(QueryProgram, FollowsADrawnLine) {
    const auto way = copy_of(way_at(small_country(), 0));
    const auto line = fmt::format(
        R"({{"type":"FeatureCollection","features":[{{"type":"Feature","properties":{{"name":"Tour"}},"geometry":{{"type":"LineString","coordinates":[[{},{}],[{},{}]]}}}}]}})",
        way.line.front().lon_deg,
        way.line.front().lat_deg,
        way.line.back().lon_deg,
        way.line.back().lat_deg);
    const auto gpx = fmt::format(
        R"(<gpx version="1.1" xmlns="http://www.topografix.com/GPX/1/1"><trk><trkseg><trkpt lat="{}" lon="{}"/><trkpt lat="{}" lon="{}"/></trkseg></trk></gpx>)",
        way.line.front().lat_deg,
        way.line.front().lon_deg,
        way.line.back().lat_deg,
        way.line.back().lon_deg);
    for (const auto& name : {file("line.geojson", line), file("line.gpx", gpx)}) {
        const auto sections = answer({"--along", name});
        ASSERT_THAT(sections, SizeIs(2)) << name; // of 100 m
        EXPECT_NEAR(sections[1].at("to_m").get<double>(), 200, 1);
        EXPECT_NEAR(sections[0].at("iri").get<double>(), mean_iri(measured_, true, 0, 100), 0.02);
    }
    EXPECT_EQ(answer({"--sections", file("line.geojson", line)}).at(0).at("section"), "Tour");
}

TEST_F(QueryProgram, ReportsAnAgencysOwnSections) {
    const auto table = file("s.csv",
                            "section,way_id,route,from_km,to_km\n"
                            "a,1,,0,0.05\n"
                            "b,1,,0.15,0.05\n"
                            "\"c, all\",,Rue de l'Épée 100%,,\n"
                            "d,3,,,\n");
    const auto sections = answer({"--sections", table});
    ASSERT_THAT(sections, SizeIs(4));
    EXPECT_NEAR(sections[0].at("iri").get<double>(), mean_iri(measured_, true, 0, 50), 0.001);
    EXPECT_EQ(sections[1].at("from_m"), 150);
    EXPECT_EQ(sections[1].at("to_m"), 50);
    EXPECT_NEAR(sections[1].at("iri").get<double>(), mean_iri(measured_, false, 50, 150), 0.001);
    EXPECT_EQ(sections[2].at("section"), "c, all");
    EXPECT_NEAR(sections[2].at("iri").get<double>(), mean_iri(measured_, true, 0, 300), 0.001);
    EXPECT_EQ(sections[3].at("covered"), 0); // nobody drove way 3
    EXPECT_TRUE(sections[3].at("iri").is_null());

    const auto out = (folder_ / "out.csv").string();
    const auto run = run_macadam({"export", store_, "-o", out, "--sections", table});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_EQ(read_file(out), query({"--sections", table, "--format", "csv"}).out);
    EXPECT_EQ(lines_in(read_file(out)), 5U);
}

TEST_F(QueryProgram, LeavesOutWhatIsExcluded) {
    const auto table = file("s.csv", "way_id,from_m,to_m\n1,0,100\n");
    const auto works =
        file("works.csv", fmt::format("lat_deg,lon_deg,radius_m\n{},20\n", place(0.25)));
    const auto section = answer({"--sections", table, "--exclude", works}).at(0);
    EXPECT_NEAR(section.at("excluded_m").get<double>(), 40, 2);
    EXPECT_NEAR(section.at("measured_m").get<double>(), 60, 2);
    EXPECT_EQ(section.at("covered"), 1.0);
    const double open =
        30 * mean_iri(measured_, true, 0, 30) + 30 * mean_iri(measured_, true, 70, 100);
    EXPECT_NEAR(section.at("iri").get<double>(), open / 60, 0.1); // borders to a metre
}

TEST_F(QueryProgram, RefusesSectionsInWords) {
    const auto refused = [&](const std::string& text) {
        const auto run = query({"--sections", file("s.csv", text)});
        EXPECT_EQ(run.exit_status, 1) << text;
        EXPECT_THAT(run.out, IsEmpty());
        return run.err;
    };
    EXPECT_THAT(refused("name,from_m,to_m\n"),
                HasSubstr("s.csv:1: the header has no column route or way_id"));
    EXPECT_THAT(refused("way_id,from,to\n1,0,1\n"),
                HasSubstr("s.csv:1: columns from and to have no unit"));
    EXPECT_THAT(refused("way_id,from_m\n1,0\n"), HasSubstr("s.csv:1: the header has only from_m"));
    EXPECT_THAT(refused("way_id,from_m,to_m,from_km,to_km\n"),
                HasSubstr("s.csv:1: the header has both from_m and from_km"));
    EXPECT_THAT(refused("way_id,way_id\n"), HasSubstr("s.csv:1: column 'way_id' occurs twice"));
    EXPECT_THAT(refused("way_id,from_m,to_m\n1,0\n"),
                HasSubstr("s.csv:2: '1,0' has 2 cells, expected 3"));
    EXPECT_THAT(refused("way_id,from_m,to_m\n1,x,9\n"),
                HasSubstr("s.csv:2: from_m is 'x', expected a station"));
    EXPECT_THAT(refused("way_id,from_m,to_m\n1,5,5\n"),
                HasSubstr("s.csv:2: begins and ends at the same station"));
    EXPECT_THAT(refused("way_id,from_m,to_m\n1,500,600\n"),
                HasSubstr("s.csv:2: extends from 500 to 600 m, expected a part of the road"));
    EXPECT_THAT(refused("way_id\n77\n"), HasSubstr("s.csv:2: the network has no way '77'"));
    EXPECT_THAT(refused("way_id\n7.5\n"),
                HasSubstr("s.csv:2: way_id is '7.5', expected a whole number"));
    EXPECT_THAT(refused("route\nElm Street\n"),
                HasSubstr("s.csv:2: the network has no road 'Elm Street'"));
    EXPECT_THAT(refused("route,way_id\nx,1\n"),
                HasSubstr("s.csv:2: has both a route and a way_id"));
    EXPECT_THAT(refused("way_id,direction\n1,north\n"), HasSubstr("s.csv:2: direction is 'north'"));
    EXPECT_THAT(refused("way_id\n"), HasSubstr("s.csv: contains no section"));
    EXPECT_THAT(query({"--along", file("s.csv", "way_id\n1\n")}).err,
                HasSubstr("is a table, expected a GPX track"));
    EXPECT_THAT(query({"--route", place(0.5), "10,10"}).err,
                HasSubstr("no road within 500 m of 10.00000,10.00000"));
    const auto table = file("t.csv", "way_id\n1\n");
    EXPECT_THAT(query({"--sections", table, "--exclude", file("x.csv", "lat,lon\n")}).err,
                HasSubstr("x.csv:1: the header has no columns lat_deg and lon_deg"));
    EXPECT_THAT(
        query({"--sections", table, "--exclude", file("x.csv", "lat_deg,lon_deg\n1,\n")}).err,
        HasSubstr("x.csv:2: has no position"));
    EXPECT_THAT(run_macadam({"export", store_, "-o", table, "--sections", table}).err,
                HasSubstr("t.csv"));
    const auto over = query({"--sections", table, "-o", table});
    EXPECT_EQ(over.exit_status, 1);
    EXPECT_THAT(over.err, HasSubstr("t.csv: is also an input"));
    EXPECT_EQ(read_file(table), "way_id\n1\n"); // and it is still there
    EXPECT_THAT(query({"--way", "1", "-o", "/dev/null"}).err,
                HasSubstr("/dev/null: is a device or pipe"));
}

TEST_F(QueryProgram, SaysWhatDoesNotGoTogether) {
    for (const auto& [words, says] : std::vector<std::pair<std::vector<std::string>, std::string>>{
             {{}, "expected a selection: --near, --bbox"},
             {{"--way", "1", "--heading", "9"}, "--heading requires --near LAT,LON"},
             {{"--near", "1,2", "--heading", "400"}, "--heading is 400, expected 0 to 360"},
             {{"--way", "1", "--class", "bad"}, "--class is 'bad', expected good or fair or poor"},
             {{"--way", "1", "--min-passes", "-1"}, "--min-passes is -1, expected 0 or more"},
             {{"--way", "1", "--since", "yesterday"},
              "--since is 'yesterday', expected a time such as"},
             {{"--way", "1", "--since", "2026-02-30"}, "--since is '2026-02-30'"},
             {{"--way", "1", "--since", "2026-03", "--until", "2026-02"},
              "expected a time after --since"},
             {{"--way", "1", "--passes"}, "--passes requires --segment KEY"},
             {{"--segment", "1+0003", "--passes", "--min-cars", "9"},
              "--passes requires --segment KEY and no other selection"},
             {{"--segment", "1+0003", "--changes", "--class", "poor"},
              "--changes requires --segment KEY and no other selection"},
             {{"--way", "1", "-o", "a.geojsn"},
              "-o is 'a.geojsn', expected a name that ends in .json, .csv, .geojson, or --format"},
             {{"--way", "1", "--history", "--format", "geojson"},
              "--history has no --format geojson"},
             {{"--worst", "1", "--history"}, "--history cannot be combined with --worst"},
             {{"--route", "1,2"}, "--route has 1 points, expected two"},
             {{"--route", "1,2", "north"}, "--route has 'north', expected LAT,LON"},
             {{"--route", "1,2", "91,0"}, "--route is 91,0, expected latitude,longitude"},
             {{"--route", "1,2", "1,3", "--way", "1"}, "not with options that select segments"},
             {{"--route", "1,2", "1,3", "--along", "x"}, "cannot be combined, expected one"},
             {{"--along", "x", "--shortest"}, "--shortest requires --route"},
             {{"--along", "x", "--section-length", "0.1ft"},
              "--section-length is '0.1ft', expected 1 m"},
             {{"--along", "x", "--section-length", "9", "--homogeneous"}, "expected one"},
             {{"--way", "1", "--homogeneous"},
              "--homogeneous requires --sections FILE, --route or --along"}}) {
        const auto run = query(words);
        EXPECT_EQ(run.exit_status, 2) << says;
        EXPECT_THAT(run.err, HasSubstr(says));
    }
    EXPECT_THAT(run_macadam({"export", store_, "-o", "x.gpkg", "--sections", "y"}).err,
                HasSubstr("expected a name that ends in .csv, .geojson or .xlsx with --sections"));
}

// ----------------------------------------------------------------------------------------- info

TEST_F(QueryProgram, InfoTellsOfRoadClassesCarsAndDays) {
    const auto run = run_macadam({"info", store_, "--json"});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    const auto info = Json::parse(run.out);
    double network_km = 0, km = 0;
    for (const auto& road : info.at("road_classes")) {
        network_km += road.at("network_km").get<double>();
        km += road.at("km").get<double>();
        double of_classes = 0;
        for (const auto& roughness : road.at("classes")) {
            of_classes += roughness.at("km").get<double>();
        }
        EXPECT_NEAR(of_classes, road.at("km").get<double>(), 0.003);
    }
    EXPECT_NEAR(network_km, info.at("network_km").get<double>(), 0.005);
    EXPECT_NEAR(km, info.at("km").get<double>(), 0.005);

    double shares = 0;
    for (const auto& car : info.at("cars")) {
        shares += car.at("share").get<double>();
        EXPECT_EQ(car.at("passes"), 40); // two trips of 20 passes each
    }
    EXPECT_THAT(info.at("cars"), SizeIs(3));
    EXPECT_NEAR(shares, 1, 0.001);
    EXPECT_THAT(info.at("passes_per_day"), SizeIs(5));
    for (const auto& day : info.at("passes_per_day")) {
        EXPECT_EQ(day.at("passes"), 20);
        EXPECT_EQ(day.at("trips"), 1);
    }
    const auto text = run_macadam({"info", store_}).out;
    EXPECT_THAT(text, HasSubstr("\nresidential "));
    EXPECT_THAT(text, HasSubstr("\nroad class "));
    EXPECT_THAT(text, HasSubstr("\nmonth "));
}

} // namespace
} // namespace macadam::testing
