// What `match` prints, of logs and of GPX tracks.

#include "support/program/places.hpp"
#include "support/program/program.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

const auto source = fs::path{source_folder()};
const auto andorra = (source / "sample_data/networks/andorra.osm.pbf").string();
const auto tour = (source / "tests/data/gpx/andorra_for_map_matching.gpx").string();

constexpr const char* columns = "way_id,from_node,to_node,direction,from_m,to_m,t_enter_s,"
                                "t_leave_s,confidence,kind,reason";

std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines{csv};
    for (std::string line; std::getline(lines, line);) {
        rows.emplace_back();
        std::istringstream cells{line + ","};
        for (std::string cell; std::getline(cells, cell, ',');) {
            rows.back().push_back(cell);
        }
    }
    return rows;
}

Run expect_done(const std::vector<std::string>& words) {
    auto run = run_macadam(words);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run;
}

/// Three edges of 400 m in a row as a line layer, the second drawn against the others.
std::string three_edges(const fs::path& folder) {
    const auto edge = [](int id, double from_deg, double to_deg) {
        return fmt::format(R"({{"type":"Feature","properties":{{"road":{}}},"geometry":{{"type":)"
                           R"("LineString","coordinates":[[{},0.5],[{},0.5]]}}}})",
                           id,
                           from_deg,
                           to_deg);
    };
    const auto file = folder / "edges.geojson";
    write_file(file,
               R"({"type":"FeatureCollection","features":[)" + edge(71, 6, 6.0036) + "," +
                   edge(72, 6.0072, 6.0036) + "," + edge(73, 6.0072, 6.0108) + "]}");
    return file.string();
}

/// 1,000 m eastwards along them, at 10 m/s; it slows down and speeds up, so that place and travel
/// run together at changing paces.
std::string log_over_three_edges(const fs::path& folder) {
    constexpr double deg_per_m = 1 / 111315.0; // of longitude, near the equator
    std::string log = "# macadam-trip 1\n# gnss_latency_s: 0\nt_s,speed_mps,lat_deg,lon_deg\n";
    for (int i = 0; i <= 1000; ++i) {
        const double t_s = 0.1 * i;
        const double east_m = 100 + 10 * t_s + 3 * std::sin(t_s);
        log += i % 10 == 0 ? fmt::format("{:.1f},10,0.5,{:.8f}\n", t_s, 6 + east_m * deg_per_m)
                           : fmt::format("{:.1f},10,,\n", t_s);
    }
    const auto file = folder / "drive.trip.csv";
    write_file(file, log + "# end rows: 1001\n");
    return file.string();
}

TEST(MatchProgram, PrintsOneRowForEachTraversalOfAnEdge) {
    const auto folder = fresh_folder();
    const auto run = expect_done({"match",
                                  log_over_three_edges(folder),
                                  "--network",
                                  three_edges(folder),
                                  "--id-column",
                                  "road"});
    EXPECT_THAT(run.out, StartsWith(columns));
    const auto rows = rows_of(run.out);
    ASSERT_THAT(rows, SizeIs(1 + 3));
    const char* const ways[] = {"71", "72", "73"};
    const char* const directions[] = {"forward", "backward", "forward"};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& row = rows[i + 1];
        ASSERT_THAT(row, SizeIs(11));
        EXPECT_EQ(row[0], ways[i]);
        EXPECT_EQ(row[3], directions[i]);
        EXPECT_LT(std::stod(row[4]), std::stod(row[5]));
        EXPECT_LT(std::stod(row[6]), std::stod(row[7]));
        EXPECT_EQ(row[9], "road");
    }
    EXPECT_EQ(rows[1][2], rows[2][1]); // each begins at the node where the one before it ends
    EXPECT_EQ(rows[2][2], rows[3][1]);
    EXPECT_NEAR(std::stod(rows[1][4]), 100, 10); // along the way, from its first node
    EXPECT_NEAR(std::stod(rows[3][5]), 1100 - 2 * 400.7, 15);
}

TEST(MatchProgram, NumbersTheNodesOfALineLayerFromOne) {
    const auto folder = fresh_folder();
    const auto arcs = expect_done(
        {"match", log_over_three_edges(folder), "--network", three_edges(folder), "--arcs"});
    const auto rows = rows_of(arcs.out);
    ASSERT_THAT(rows, SizeIs(1 + 3));
    EXPECT_THAT(arcs.out, StartsWith("from_node,to_node,way_id,t_enter_s\n1,2,"));
}

TEST(MatchProgram, SaysKilometresAndConfidence) {
    const auto folder = fresh_folder();
    const auto run =
        expect_done({"match", log_over_three_edges(folder), "--network", three_edges(folder)});
    EXPECT_THAT(run.err,
                ContainsRegex("(0.9[0-9]|1.0[0-9]) km on roads \\(confidence (1.00|0.9[0-9])\\), "
                              "0.00 km off the network, 0.00 km in gaps"));
}

TEST(MatchProgram, WritesOneFeatureForEachRow) {
    const auto folder = fresh_folder();
    const auto file = (folder / "match.geojson").string();
    expect_done(
        {"match", log_over_three_edges(folder), "--network", three_edges(folder), "-o", file});
    const auto text = read_file(file);
    std::size_t features = 0;
    for (auto at = text.find("\"Feature\""); at != std::string::npos;
         at = text.find("\"Feature\"", at + 1)) {
        ++features;
    }
    EXPECT_EQ(features, 3U);
    EXPECT_THAT(text, HasSubstr("\"LineString\""));
}

TEST(MatchProgram, SaysInFeaturesHowSureThePlaceIs) {
    const auto folder = fresh_folder();
    const auto file = (folder / "match.geojson").string();
    expect_done(
        {"match", log_over_three_edges(folder), "--network", three_edges(folder), "-o", file});
    const auto text = read_file(file);
    constexpr std::string_view name = "\"offset_sd_m\":";
    auto at = text.find(name);
    ASSERT_NE(at, std::string::npos);
    for (; at != std::string::npos; at = text.find(name, at + 1)) {
        const double sd_m = std::stod(text.substr(at + name.size()));
        EXPECT_GT(sd_m, 0.3); // a fix a second that errs by metres, and a speed sensor
        EXPECT_LT(sd_m, 5);
    }
}

TEST(MatchProgram, TakesAGpxTrackWithoutTimesAndSaysSo) {
    const auto run = expect_done({"match", tour, "--network", andorra});
    EXPECT_THAT(run.err, HasSubstr("its points have no increasing times; made up at 10 m/s"));
    EXPECT_THAT(run.err, HasSubstr("0.00 km off the network, 0.00 km in gaps"));
    EXPECT_THAT(run.out, StartsWith(columns));
}

TEST(MatchProgram, RefusesAGpxFileWithoutATrack) {
    const auto run = run_macadam(
        {"match", (source / "tests/data/gpx/no_trkpt.gpx").string(), "--network", andorra});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err,
                HasSubstr("no_trkpt.gpx:7: contains 1 track, 1 segment only, expected a track "
                          "(trk) with points (trkpt)"));
    EXPECT_EQ(run.out, "");
}

TEST(MatchProgram, LeavesGpxTracksToThoseWhoNeedPositionsAlone) {
    const auto run = run_macadam({"trace", tour});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_THAT(run.err, HasSubstr("is a GPX track, which has positions only"));
}

TEST(MatchProgram, ReadsAConvertedGpxTrackAsTheTrack) {
    const auto log = (fresh_folder() / "tour.trip.csv").string();
    expect_done({"convert", tour, "-o", log});
    EXPECT_EQ(expect_done({"match", log, "--network", andorra}).out,
              expect_done({"match", tour, "--network", andorra}).out);
}

TEST(MatchProgram, MatchesAGpxTrackToRoadsDrawnFromIt) {
    const auto folder = fresh_folder();
    std::string points;
    for (int i = 0; i <= 60; ++i) {
        points += fmt::format("<trkpt lat=\"47\" lon=\"{:.6f}\"><time>2020-05-01T10:{:02}:{:02}Z"
                              "</time></trkpt>\n",
                              8 + i * 0.0001,
                              i / 60,
                              i % 60);
    }
    const auto gpx = (folder / "drive.gpx").string();
    write_file(gpx, "<gpx><trk><trkseg>" + points + "</trkseg></trk></gpx>");
    const auto store = (folder / "roads.gpkg").string();
    expect_done({"init", store, "--trace", folder.string()});
    const auto rows = rows_of(expect_done({"match", gpx, "--network", store}).out);
    ASSERT_THAT(rows, SizeIs(2)); // one way, from its node 1
    EXPECT_EQ(rows[1][0], "1");
    EXPECT_EQ(rows[1][1], "1");
}

TEST(MatchProgram, TakesAStoreItsNetworkBesideItOrTheMapForTheSame) {
    const auto folder = fresh_folder();
    const auto store = (folder / "roads.gpkg").string();
    const auto beside = store + "-network";
    expect_done({"init", store, "--network", andorra, "--segment-length", "500"});
    ASSERT_TRUE(fs::exists(beside));
    const auto of_map = expect_done({"match", tour, "--network", andorra}).out;
    EXPECT_EQ(expect_done({"match", tour, "--network", store}).out, of_map);
    EXPECT_EQ(expect_done({"match", tour, "--network", beside}).out, of_map);

    const auto bytes = read_file(beside);
    write_file(beside, bytes.substr(0, bytes.size() / 2));
    const auto refused = run_macadam({"match", tour, "--network", beside});
    EXPECT_EQ(refused.exit_status, 1);
    EXPECT_THAT(refused.err,
                ContainsRegex("roads.gpkg-network: has [0-9]+ bytes, expected [0-9]+: it is "
                              "truncated"));
    EXPECT_EQ(expect_done({"match", tour, "--network", store}).out, of_map);
    EXPECT_EQ(read_file(beside), bytes); // made again
}

} // namespace
} // namespace macadam::testing
