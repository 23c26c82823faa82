#include "storage/networks/background/osm_background.hpp"

#include "support/files/files.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <map>

namespace macadam {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::refusal_of;
using ::testing::SizeIs;
using testing::test_folder;
using testing::written;

constexpr GeoBox everywhere{.west_deg = -180, .south_deg = -85, .east_deg = 180, .north_deg = 85};

/// Text of an OSM file as it is put together.
struct OsmText {
    std::string nodes, ways, relations;
    int next_node = 1;

    /// Adds the nodes of a square. \returns their ids, the first repeated at the end
    std::vector<int> square(double lat, double lon, double side) {
        const std::vector<std::pair<double, double>> corners{
            {lat, lon}, {lat, lon + side}, {lat + side, lon + side}, {lat + side, lon}};
        std::vector<int> ids;
        for (const auto& [at_lat, at_lon] : corners) {
            ids.push_back(node(at_lat, at_lon));
        }
        ids.push_back(ids.front());
        return ids;
    }

    int node(double lat, double lon, const std::string& tags = "") {
        nodes += fmt::format(
            "<node id='{}' lat='{:.7f}' lon='{:.7f}'>{}</node>", next_node, lat, lon, tags);
        return next_node++;
    }

    void way(int id, const std::vector<int>& ids, const std::string& tags = "") {
        ways += fmt::format("<way id='{}'>", id);
        for (const auto node : ids) {
            ways += fmt::format("<nd ref='{}'/>", node);
        }
        ways += tags + "</way>";
    }

    void relation(const std::vector<int>& members, const std::string& tags) {
        relations += "<relation id='1'>";
        for (const auto way : members) {
            relations += fmt::format("<member type='way' ref='{}' role=''/>", way);
        }
        relations += tags + "</relation>";
    }

    std::filesystem::path file() const {
        return written(
            test_folder(), "a.osm", "<osm version='0.6'>" + nodes + ways + relations + "</osm>");
    }
};

std::string tag(const std::string& key, const std::string& value) {
    return "<tag k='" + key + "' v='" + value + "'/>";
}

const std::string multipolygon = tag("type", "multipolygon");

struct Found {
    std::vector<BackgroundFeature> features;
    std::vector<PlaceName> places;
    std::vector<RoadRef> road_refs;
    LeftOutAreas left_out;
};

Found read(const OsmText& text,
           const GeoBox& box = everywhere,
           std::size_t max_points = 1'000'000) {
    Found found;
    found.left_out = read_osm_background(
        text.file(),
        box,
        {.feature = [&](const BackgroundFeature& each) { found.features.push_back(each); },
         .place = [&](const PlaceName& each) { found.places.push_back(each); },
         .road_ref = [&](const RoadRef& each) { found.road_refs.push_back(each); }},
        {},
        max_points);
    return found;
}

std::vector<BackgroundKind> kinds_of(const Found& found) {
    std::vector<BackgroundKind> kinds;
    for (const auto& feature : found.features) {
        kinds.push_back(feature.kind);
    }
    std::sort(kinds.begin(), kinds.end());
    return kinds;
}

TEST(OsmBackground, JoinsALakeWithAnIslandFromTheWaysOfAMultipolygon) {
    OsmText text;
    const auto shore = text.square(47, 9, 0.1);
    text.way(1, {shore[0], shore[1], shore[2]});
    text.way(2, {shore[0], shore[3], shore[2]}); // against the first
    text.way(3, text.square(47.04, 9.04, 0.02));
    text.relation({3, 1, 2}, multipolygon + tag("natural", "water"));
    const auto found = read(text);
    ASSERT_THAT(found.features, SizeIs(1));
    EXPECT_EQ(found.features[0].kind, BackgroundKind::water);
    ASSERT_THAT(found.features[0].paths, SizeIs(2));
    EXPECT_THAT(found.features[0].paths[0], SizeIs(4));
    EXPECT_EQ(std::ranges::max(found.features[0].paths[1], {}, &PackedPoint::lat_e7).lat_e7,
              470'600'000);
    EXPECT_EQ(found.left_out.not_closed, 0U);
}

TEST(OsmBackground, TellsKindsOfClosedWaysAndOfLines) {
    OsmText text;
    int id = 0;
    for (const auto& [key, value] :
         std::vector<std::pair<std::string, std::string>>{{"building", "house"},
                                                          {"landuse", "forest"},
                                                          {"landuse", "meadow"},
                                                          {"leisure", "park"},
                                                          {"landuse", "residential"},
                                                          {"landuse", "quarry"}, // not shown
                                                          {"building", "no"}}) { // likewise
        ++id;
        text.way(id, text.square(47 + id, 9, 0.1), tag(key, value));
    }
    for (const auto& tags : {tag("waterway", "river"),
                             tag("waterway", "stream"),
                             tag("railway", "rail"),
                             tag("railway", "rail") + tag("service", "yard"),
                             tag("railway", "rail") + tag("tunnel", "yes"), // not shown
                             tag("railway", "tram")}) {                     // likewise
        ++id;
        text.way(id, {text.node(47, 9 + id), text.node(48, 9 + id)}, tags);
    }
    EXPECT_THAT(kinds_of(read(text)),
                ElementsAre(BackgroundKind::built_up,
                            BackgroundKind::meadow,
                            BackgroundKind::park,
                            BackgroundKind::forest,
                            BackgroundKind::river,
                            BackgroundKind::stream,
                            BackgroundKind::building,
                            BackgroundKind::railway,
                            BackgroundKind::siding));
}

TEST(OsmBackground, TakesNamesOfPlacesAndNumbersOfRoads) {
    OsmText text;
    text.node(47.1, 9.5, tag("place", "town") + tag("name", "Vaduz") + tag("population", "5696"));
    text.node(47.2, 9.5, tag("place", "village") + tag("name", "Mauren"));
    text.node(47.2, 9.6, tag("place", "farm") + tag("name", "Hof")); // not shown
    text.node(47.2, 9.7, tag("place", "city"));                      // without a name
    text.node(60, 9.5, tag("place", "town") + tag("name", "Afar"));  // outside
    const std::vector line{text.node(47, 9), text.node(48, 9)};
    text.way(28, line, tag("highway", "primary") + tag("ref", "28"));
    text.way(29, line, tag("highway", "footway") + tag("ref", "7"));
    const auto found = read(text, {9, 47, 10, 48});
    ASSERT_THAT(found.places, SizeIs(2));
    EXPECT_EQ(found.places[0].name, "Vaduz");
    EXPECT_EQ(found.places[0].rank, PlaceRank::town);
    EXPECT_EQ(found.places[0].population, 5696);
    EXPECT_NEAR(found.places[0].position.lon_deg, 9.5, 1e-7);
    EXPECT_EQ(found.places[1].rank, PlaceRank::village);
    ASSERT_THAT(found.road_refs, SizeIs(1));
    EXPECT_EQ(found.road_refs[0].way_id, 28);
    EXPECT_EQ(found.road_refs[0].ref, "28");
}

TEST(OsmBackground, LeavesOutRingsThatAreOpenCrossThemselvesOrLackNodes) {
    OsmText text;
    const auto open = text.square(47, 9, 0.1);
    text.way(1, {open[0], open[1], open[2]});
    text.relation({1}, multipolygon + tag("natural", "water"));
    text.relation({1, 99}, multipolygon + tag("natural", "water")); // 99 is not in the file
    const auto crossing = text.square(48, 9, 0.1);
    text.way(2,
             {crossing[0], crossing[2], crossing[1], crossing[3], crossing[0]},
             tag("landuse", "forest"));
    text.way(3, {1000, 1001, 1002, 1000}, tag("landuse", "forest"));
    const auto found = read(text);
    EXPECT_THAT(found.features, IsEmpty());
    EXPECT_EQ(found.left_out.not_closed, 4U);
}

TEST(OsmBackground, BoundsTheAssemblyOfMultipolygonsThatNameTheSameWaysAgainAndAgain) {
    OsmText text;
    std::vector<int> ring;
    for (int i = 0; i < 20'000; ++i) { // a comb
        ring.push_back(text.node(i % 2 == 0 ? 47 : 47.1, 9 + i * 1e-5));
    }
    ring.push_back(text.node(46.9, 9.1));
    ring.push_back(ring.front());
    text.way(1, ring);
    for (int i = 0; i < 200; ++i) {
        text.relation({1}, multipolygon + tag("landuse", "forest"));
    }
    const auto found = read(text);
    EXPECT_GT(found.left_out.too_long, 100U);
}

TEST(OsmBackground, BoundsTheSearchForCrossingsInLongRings) {
    OsmText text;
    std::vector<int> ring;
    for (int i = 0; i < 49'000; ++i) { // a comb
        ring.push_back(text.node(i % 2 == 0 ? 47 : 47.1, 9 + i * 1e-5));
    }
    ring.push_back(text.node(46.9, 9.6));
    ring.push_back(text.node(46.9, 9));
    ring.push_back(ring.front());
    constexpr int rings = 11;
    for (int id = 1; id <= rings; ++id) {
        text.way(id, ring, tag("landuse", "forest"));
    }
    text.way(rings + 1, text.square(50, 9, 0.1), tag("landuse", "forest"));
    const auto found = read(text);
    EXPECT_THAT(found.features, SizeIs(9)); // eight of 49'003 nodes, and the square
    EXPECT_EQ(found.left_out.too_long, 3U);
}

TEST(OsmBackground, MakesTheSeaOfCoastlinesWithinTheBoundsThatTheFileStates) {
    OsmText text;
    text.nodes = "<bounds minlat='47' minlon='9' maxlat='48' maxlon='10'/>";
    text.way(1, {text.node(47.5, 9.0002), text.node(47.5, 9.9997)}, tag("natural", "coastline"));
    text.node(46, 8); // afar
    const auto found = read(text, {9, 47, 10, 48});
    ASSERT_THAT(found.features, SizeIs(1));
    EXPECT_EQ(found.features[0].kind, BackgroundKind::water);
    const auto& ring = found.features[0].paths[0];
    EXPECT_EQ(std::ranges::max(ring, {}, &PackedPoint::lat_e7).lat_e7, 475'000'000);
    EXPECT_LT(std::ranges::min(ring, {}, &PackedPoint::lat_e7).lat_e7, 470'000'000);
    EXPECT_FALSE(found.left_out.has_broken_coast);

    text.way(2, {text.node(47.7, 9.5), text.node(47.7, 9.6)}, tag("natural", "coastline"));
    const auto broken = read(text, {9, 47, 10, 48});
    EXPECT_THAT(broken.features, IsEmpty());
    EXPECT_TRUE(broken.left_out.has_broken_coast);
}

TEST(OsmBackground, IsTheSameHoweverFewPointsAreHeldAtATime) {
    OsmText text;
    for (int id = 1; id <= 9; ++id) {
        text.way(id, text.square(40 + id, 9, 0.1), tag("landuse", "forest"));
    }
    text.relation({3}, multipolygon + tag("natural", "water"));
    const auto whole = read(text);
    const auto piecemeal = read(text, everywhere, 7);
    EXPECT_THAT(whole.features, SizeIs(10));
    EXPECT_EQ(kinds_of(piecemeal), kinds_of(whole));
}

TEST(OsmBackground, GivesOnlyWhatMeetsTheBox) {
    OsmText text;
    text.way(1, text.square(47, 9, 0.1), tag("landuse", "forest"));
    text.way(2, text.square(57, 9, 0.1), tag("landuse", "forest"));
    EXPECT_THAT(read(text, {8, 46, 10, 48}).features, SizeIs(1));
}

TEST(OsmBackground, NamesTheFileThatIsDamaged) {
    const auto file = written(test_folder(), "a.osm", "<osm version='0.6'><way");
    EXPECT_THAT(refusal_of([&] { read_osm_background(file, everywhere, {}, {}); }),
                HasSubstr("a.osm: its background cannot be read: line 1: "));
}

} // namespace
} // namespace macadam
