// What roads of other people's files take of memory, by the program itself. The figures that hold
// here stand in docs/reference/road-maps.md.

#include "support/files/pbf_map.hpp"
#include "support/program/piped_program.hpp"
#include "support/program/program.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <zlib.h>

#include <cstdio>
#include <fstream>
#include <string>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;

constexpr double free_mb = 300;
constexpr double mb = 1 << 20;
constexpr std::int64_t lat_e7 = 480'000'000;
constexpr std::int64_t lon_e7 = 150'000'000;

/// Runs `init` on a map and expects it to keep to so many bytes for each byte of the content.
PipedProgram::End expect_bounded(const std::string& name,
                                 const std::string& content,
                                 double bytes_per_byte,
                                 const std::string& option = "--network") {
    const auto folder = fresh_folder();
    const auto file = folder / name;
    std::ofstream{file, std::ios::binary} << content;
    PipedProgram program{{"init", (folder / "a.gpkg").string(), option, file.string(), "--quiet"}};
    program.end_input();
    while (program.line(std::chrono::seconds{100})) {
    }
    auto end = program.wait();
    const double content_mb = static_cast<double>(content.size()) / mb;
    std::printf("%s of %.1f MB: exit %d, %.0f MB, %.0f bytes a byte beyond %.0f MB\n",
                name.c_str(),
                content_mb,
                end.exit_status,
                end.peak_mb,
                (end.peak_mb - free_mb) / content_mb,
                free_mb);
    EXPECT_LE(end.exit_status, 1) << end.err;
    EXPECT_LT(end.peak_mb, free_mb + bytes_per_byte * content_mb) << end.err;
    std::filesystem::remove_all(folder);
    return end;
}

PbfMap::Node node(std::int64_t id, std::int64_t i) {
    return {id, lat_e7 + i * 40, lon_e7 + (i % 2) * 40};
}

std::string line_feature(int id, const std::string& places) {
    return fmt::format(R"({{"type":"Feature","id":{},"properties":{{}},"geometry":)"
                       R"({{"type":"LineString","coordinates":[{}]}}}})",
                       id,
                       places);
}

std::string features(const std::string& all) {
    return R"({"type":"FeatureCollection","features":[)" + all + "]}";
}

std::string gzipped(const std::string& text) {
    std::string packed(compressBound(text.size()) + 64, '\0');
    z_stream state{};
    deflateInit2(&state, 9, Z_DEFLATED, 15 + 16, 9, Z_DEFAULT_STRATEGY);
    state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    state.avail_in = static_cast<uInt>(text.size());
    state.next_out = reinterpret_cast<Bytef*>(packed.data());
    state.avail_out = static_cast<uInt>(packed.size());
    deflate(&state, Z_FINISH);
    packed.resize(state.total_out);
    deflateEnd(&state);
    return packed;
}

constexpr double of_a_map = 300;
constexpr double of_logs = 3000;

} // namespace

TEST(NetworkMemory, OfOneWayOverAMillionPointsIsBounded) {
    PbfMap map;
    std::vector<PbfMap::Node> nodes;
    std::vector<std::int64_t> refs;
    for (std::int64_t i = 0; i < 1'000'000; ++i) {
        nodes.push_back(node(i + 1, i));
        refs.push_back(i + 1);
    }
    map.nodes(nodes).way(1, refs);
    expect_bounded("a.osm.pbf", map.end_block(PbfMap::Packing::raw).file(), of_a_map);
}

TEST(NetworkMemory, OfAHundredThousandWaysOverTheSameNodesIsBounded) {
    PbfMap map;
    map.nodes({node(1, 0), node(2, 1)});
    for (std::int64_t i = 0; i < 100'000; ++i) {
        map.way(i + 1, {1, 2}, std::string(1000, 'x'));
    }
    expect_bounded("a.osm.pbf", map.end_block(PbfMap::Packing::raw).file(), of_a_map);
}

TEST(NetworkMemory, OfMillionsOfNodesThatAreNotThereIsBounded) {
    PbfMap map;
    std::vector<std::int64_t> refs;
    for (std::int64_t i = 0; i < 4'000'000; ++i) {
        refs.push_back(i + 10);
    }
    map.nodes({node(1, 0), node(2, 1)}).way(1, {1, 2}).way(2, refs);
    expect_bounded("a.osm.pbf", map.end_block(PbfMap::Packing::raw).file(), of_a_map);
}

TEST(NetworkMemory, OfMillionsOfStepsBetweenTwoNodesIsBounded) {
    PbfMap map;
    std::vector<std::int64_t> refs;
    for (std::int64_t i = 0; i < 4'000'000; ++i) {
        refs.push_back(1 + i % 2);
    }
    map.nodes({node(1, 0), node(2, 1)}).way(1, {1, 2}).way(2, refs);
    expect_bounded("a.osm.pbf", map.end_block(PbfMap::Packing::raw).file(), of_a_map);
}

TEST(NetworkMemory, OfTurnRestrictionsByTheThousandAtOneNodeIsBounded) {
    std::string xml = "<osm version='0.6'><node id='1' lat='48' lon='15'/>";
    for (int i = 2; i < 10'000; ++i) {
        xml += fmt::format(
            "<node id='{0}' lat='48.001' lon='15.{0:06}'/>"
            "<way id='{0}'><nd ref='1'/><nd ref='{0}'/><tag k='highway' v='service'/></way>"
            "<relation id='{0}'><member type='way' ref='{0}' role='from'/>"
            "<member type='node' ref='1' role='via'/><member type='way' ref='{1}' role='to'/>"
            "<tag k='type' v='restriction'/><tag k='restriction' v='only_straight_on'/></relation>",
            i,
            2 + (i + 1) % 9'000);
    }
    expect_bounded("a.osm", xml + "</osm>", of_a_map);
}

TEST(NetworkMemory, OfALineLayerIsBounded) {
    std::string places;
    std::string many;
    for (int i = 0; i < 300'000; ++i) {
        places += fmt::format("{}[15,{:.6f}]", i == 0 ? "" : ",", 48 + i * 1e-6);
    }
    for (int i = 0; i < 20'000; ++i) {
        many += (i == 0 ? "" : ",") +
                line_feature(i, fmt::format("[15,{0:.4f}],[15.001,{0:.4f}]", i * 1e-3));
    }
    expect_bounded("one.geojson", features(line_feature(1, places)), of_a_map);
    expect_bounded("many.geojson", features(many), of_a_map);
}

TEST(NetworkMemory, OfPointsFarApartIsBounded) {
    std::string far;
    std::string nearer;
    for (int i = 0; i < 5000; ++i) { // 49 km to and fro, by another degree each time
        nearer +=
            fmt::format("{}[{},{:.4f}]", i == 0 ? "" : ",", i % 2 == 0 ? "15" : "15.44", i * 1e-4);
        far +=
            fmt::format("{}[{},{:.4f}]", i == 0 ? "" : ",", i % 2 == 0 ? "15" : "-160", i * 1e-4);
    }
    EXPECT_THAT(expect_bounded("far.geojson", features(line_feature(1, far)), of_a_map).err,
                HasSubstr("1 way with points more than 50 km apart"));
    std::string ways; // of 80 points, 3,900 km, each
    for (int i = 0; i < 40; ++i) {
        std::string one;
        for (int k = 0; k < 80; ++k) {
            one += fmt::format("{}[{},{:.4f}]",
                               k == 0 ? "" : ",",
                               k % 2 == 0 ? "15" : "15.44",
                               i * 0.01 + k * 1e-4);
        }
        ways += (i == 0 ? "" : ",") + line_feature(i, one);
    }
    EXPECT_THAT(expect_bounded("many.geojson", features(ways), of_a_map).err,
                HasSubstr("too long for their 3200 points"));
    EXPECT_THAT(expect_bounded("long.geojson", features(line_feature(1, nearer)), of_a_map).err,
                HasSubstr("longer than 4295 km"));
}

TEST(NetworkMemory, OfPackedBombsIsBounded) {
    const std::string text = "<osm version='0.6'><node id='1' lat='48' lon='15'/><way id='1'>";
    std::string bomb = text;
    for (int i = 0; i < 4'000'000; ++i) {
        bomb += "<nd ref='1'/>";
    }
    EXPECT_THAT(expect_bounded("a.osm.gz", gzipped(bomb), of_a_map).err,
                HasSubstr("it unpacks to more than 100 times its size"));
    PbfMap map;
    map.nodes({node(1, 0), node(2, 1)}).way(1, {1, 2}).end_block();
    const std::string zeros(30 << 20, '\0');
    for (int i = 0; i < 20; ++i) {
        map.blob("OSMData", zeros, PbfMap::Packing::zlib, static_cast<std::int64_t>(zeros.size()));
    }
    EXPECT_THAT(expect_bounded("a.osm.pbf", map.file(), of_a_map).err,
                HasSubstr("it unpacks to more than 20 times its size"));
}

TEST(NetworkMemory, OfRoadsDrawnByATripOfLongJumpsIsBounded) {
    std::string log = "# macadam-trip 1\nt_s,lat_deg,lon_deg\n";
    constexpr int rows = 20'000;
    for (int i = 0; i < rows; ++i) { // 800 m each 10 s, round and round
        log += fmt::format("{},{:.4f},{:.4f}\n",
                           10 * i,
                           48 + 0.0072 * (i % 200),
                           15 + 0.0001 * static_cast<double>(i / 200));
    }
    expect_bounded("a.trip.csv", log + fmt::format("# end rows: {}\n", rows), of_logs, "--trace");
}

} // namespace macadam::testing
