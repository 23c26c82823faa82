#include "mapping/network/build_network.hpp"
#include "storage/networks/network_reader.hpp"

#include "support/files/compressed.hpp"
#include "support/files/files.hpp"
#include "support/files/pbf_map.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <limits>

using namespace macadam;
using namespace macadam::testing;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

namespace {

constexpr std::int64_t e7 = 10'000'000;

struct Told {
    std::vector<Way> ways;
    std::string words; ///< of what was left out
};

Told told_of(const std::string& name, const std::string& content) {
    Told told;
    told.ways = read_network(written(test_folder(), name, content), {}, {}, [&](const auto& words) {
        told.words = words;
    });
    return told;
}

Told told_of(PbfMap& map) {
    return told_of("a.osm.pbf", map.file());
}

std::string refusal_of_map(const std::string& name, const std::string& content) {
    return refusal_of([&] { told_of(name, content); });
}

/// Three nodes in a row, 1 km apart, and a road over two of them.
PbfMap little_map() {
    PbfMap map;
    map.nodes(
           {{1, 48 * e7, 15 * e7}, {2, 48 * e7 + 90'000, 15 * e7}, {3, 48 * e7 + 180'000, 15 * e7}})
        .way(10, {1, 2}, "Am Hof");
    return map;
}

std::string xml_of(const std::string& content) {
    return "<osm version='0.6'><node id='1' lat='48' lon='15'/><node id='2' lat='48.01' "
           "lon='15'/>" +
           content + "</osm>";
}

std::string xml_road(std::int64_t id, const std::string& refs) {
    return fmt::format("<way id='{}'>{}<tag k='highway' v='residential'/></way>", id, refs);
}

} // namespace

TEST(HostileMap, OfBlobsThatUnpackToFarMoreThanAMapDoesIsRefused) {
    const std::string zeros(3 << 20, '\0');
    auto map = little_map();
    map.end_block().blob(
        "OSMData", zeros, PbfMap::Packing::zlib, static_cast<std::int64_t>(zeros.size()));
    EXPECT_THAT(refusal_of_map("a.osm.pbf", map.file()),
                EndsWith("it unpacks to more than 20 times its size, which no map does"));
    const auto bomb = xml_of(std::string(48 << 20, ' ')); // 16 MiB grow at will
    EXPECT_THAT(refusal_of_map("a.osm.gz", gzipped(bomb)),
                EndsWith("it unpacks to more than 100 times its size, which no map does"));
    EXPECT_THAT(
        told_of("b.osm",
                xml_of(xml_road(7, "<nd ref='1'/><nd ref='2'/>") + std::string(1 << 20, ' ')))
            .ways,
        SizeIs(1));
}

TEST(HostileMap, OfBlobsThatSayAnotherSizeThanTheyHaveIsRefused) {
    for (const std::int64_t told : {-1L, 0L, 10L, 1L << 25, (1L << 25) + 1}) {
        auto map = little_map();
        map.end_block().blob("OSMData", "some content", PbfMap::Packing::zlib, told);
        EXPECT_THAT(refusal_of_map("a.osm.pbf", map.file()), HasSubstr("a blob")) << told;
    }
    auto map = little_map();
    EXPECT_THAT(refusal_of_map("a.osm.pbf", map.file() + std::string("\0\1\0\1", 4)),
                HasSubstr("a blob's header of 65537 bytes"));
    EXPECT_THAT(refusal_of_map("a.osm.pbf", map.file() + std::string("\0\0", 2)),
                EndsWith("it is truncated"));
}

TEST(HostileMap, WithARoadOverTheSameNodesAgainAndAgainIsReadWithoutIt) {
    std::vector<std::int64_t> refs;
    for (int i = 0; i < 100'000; ++i) {
        refs.push_back(1 + i % 3);
    }
    auto map = little_map();
    map.way(11, refs).end_block(PbfMap::Packing::raw);
    const auto told = told_of(map);
    ASSERT_THAT(told.ways, SizeIs(1));
    EXPECT_EQ(told.ways[0].id, 10);
    EXPECT_THAT(told.words, EndsWith("a.osm.pbf: skipped: 1 way repeating the same few nodes"));
    EXPECT_THAT(told_of("a.osm", xml_of(xml_road(7, "<nd ref='1'/><nd ref='2'/>"))).words,
                IsEmpty());
}

TEST(HostileMap, WithPointsOfARoadFarApartIsReadWithoutIt) {
    auto map = little_map();
    map.nodes({{4, 50 * e7, 15 * e7}, {5, -48 * e7, -165 * e7}}).way(11, {1, 4}).way(12, {3, 5});
    const auto told = told_of(map);
    EXPECT_THAT(told.ways, SizeIs(1));
    EXPECT_THAT(told.words, EndsWith("skipped: 2 ways with points more than 50 km apart"));

    const std::string line = R"({"type":"LineString","coordinates":[[15,0],[-165,0]]})";
    EXPECT_THAT(refusal_of_map("a.geojson",
                               R"({"type":"Feature","properties":{},"geometry":)" + line + "}"),
                EndsWith("skipped: 1 way with points more than 50 km apart; it contains no "
                         "other drivable road"));
}

TEST(HostileMap, WithARestrictionFromManyWaysToManyHasNoTurnsOfIt) {
    std::vector<std::int64_t> many(20'000, 10);
    auto map = little_map();
    map.way(11, {2, 3}).restriction(many, 2, many).restriction({10}, 2, {11});
    const auto ways = told_of(map).ways;
    ASSERT_THAT(ways, SizeIs(2));
    EXPECT_THAT(ways[0].turns, ElementsAre(TurnRule{2, 11, 0}));
}

TEST(HostileMap, WithIdsAtTheEndsOfTheirRangeIsRead) {
    constexpr auto least = std::numeric_limits<std::int64_t>::min();
    constexpr auto most = std::numeric_limits<std::int64_t>::max();
    PbfMap map;
    map.nodes({{most, 48 * e7, 15 * e7}, {least, 48 * e7 + 1000, 15 * e7}})
        .way(most, {least, most})
        .way(least, {most, least});
    const auto ways = told_of(map).ways;
    ASSERT_THAT(ways, SizeIs(2));
    EXPECT_EQ(ways[0].id, least);
    EXPECT_THAT(ways[1].node_ids, ElementsAre(least, most));
    EXPECT_EQ(link_count(build_network(ways)), 2U);

    const auto xml =
        fmt::format("<osm version='0.6'><node id='{0}' lat='48' lon='15'/>"
                    "<node id='{1}' lat='48.1' lon='15'/>{2}</osm>",
                    least,
                    most,
                    xml_road(most, fmt::format("<nd ref='{}'/><nd ref='{}'/>", least, most)));
    EXPECT_THAT(told_of("a.osm", xml).ways, SizeIs(1));
    EXPECT_THAT(refusal_of_map("a.osm", xml_of(xml_road(1, "<nd ref='9223372036854775808'/>"))),
                HasSubstr("an id is '9223372036854775808', expected a whole number"));
}

TEST(HostileMap, WithANameOfThousandsOfLettersIsRefused) {
    auto map = little_map();
    map.way(11, {2, 3}, std::string(1025, 'x'));
    EXPECT_THAT(refusal_of_map("a.osm.pbf", map.file()),
                EndsWith("the name of way '11' has 1025 bytes, expected at most 1024"));
}

TEST(HostileMap, WithNodesBeyondTheGlobeHasNoRoadsThere) {
    const std::string no_places = "contains no drivable road: the positions of the points of its 1 "
                                  "way are missing";
    for (const std::int64_t lat_e7 :
         {90 * e7 + 1, -91 * e7, std::numeric_limits<std::int64_t>::max()}) {
        PbfMap map;
        map.nodes({{1, 48 * e7, 15 * e7}, {2, lat_e7, 15 * e7}}).way(10, {1, 2});
        EXPECT_THAT(refusal_of_map("a.osm.pbf", map.file()), EndsWith(no_places));
    }
    for (const auto* const lat : {"91", "nan", "inf", "1e999", "", "48,1"}) {
        const auto xml = fmt::format("<osm version='0.6'><node id='1' lat='48' lon='15'/>"
                                     "<node id='2' lat='{}' lon='15'/>{}</osm>",
                                     lat,
                                     xml_road(7, "<nd ref='1'/><nd ref='2'/>"));
        EXPECT_THAT(refusal_of_map("a.osm", xml), EndsWith(no_places)) << lat;
    }
}

// GDAL would go around the globe once for every 40,000 km.
TEST(HostileMap, WithACoordinateFarBeyondTheGlobeIsRefused) {
    for (const char* const east : {"9223372036854775807", "-1e300"}) {
        EXPECT_THAT(
            refusal_of_map(
                "far.geojson",
                fmt::format(R"({{"type":"Feature","crs":{{"type":"name","properties":{{)"
                            R"("name":"EPSG:3857"}}}},"properties":{{}},"geometry":{{"type":)"
                            R"("LineString","coordinates":[[{},6126000],[0,6126010]]}}}})",
                            east)),
            EndsWith("cannot be converted to degrees"));
    }
}

TEST(HostileMap, OfXmlWithEntitiesOrDeepElementsIsRefused) {
    EXPECT_THAT(refusal_of_map("a.osm", "<!DOCTYPE osm [<!ENTITY a 'aaaa'>]>" + xml_of("")),
                HasSubstr("declares an entity, expected none"));
    std::string deep;
    for (int i = 0; i < 100'000; ++i) {
        deep += "<a>";
    }
    EXPECT_THAT(refusal_of_map("a.osm", xml_of(deep)), HasSubstr("elements lie more than 64 deep"));
}

TEST(HostileMap, OfOneBlobWithoutAHeaderOrWithUnknownFeaturesIsRefused) {
    std::string header;
    header = std::string("\x22\x15", 2) + "HistoricalInformation"; // required_features
    PbfMap map;
    map.blob("OSMHeader", header, PbfMap::Packing::raw, 0);
    EXPECT_THAT(refusal_of_map("a.osm.pbf", map.file()),
                EndsWith("it needs the feature 'HistoricalInformation', expected a plain map"));
    EXPECT_THAT(refusal_of_map("a.osm.pbf", ""), EndsWith("it is empty"));
}
