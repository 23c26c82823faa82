// OGC API - Tiles over real sockets, after the abstract tests of OGC 20-057, annex A.

#include "app/export/tile_export.hpp"
#include "app/export/tile_square_painter.hpp"
#include "app/serve/live/picture_tiles.hpp"
#include "app/site/site_page.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/files/gzip.hpp"
#include "storage/store/road_store.hpp"
#include "support/http/served_store.hpp"
#include "support/program/shell.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// TileJSON, once the tiles are made.
nlohmann::json tile_json_of(const ServedWorld& served) {
    while (served.ask("/tiles.json").status == 503) { // the test's time limit ends it
        std::this_thread::sleep_for(std::chrono::milliseconds{20});
    }
    return served.page("/tiles.json");
}

std::string bytes_of(const fs::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

TEST(OgcTiles, ServesTheTilesThatExportsHave) { // core/tc-op, tc-success
    const ServedWorld served;
    tile_json_of(served);
    const auto folder = served.file.parent_path() / "tiles";
    export_tiles(StoreReader::open(served.file),
                 {},
                 folder / "",
                 {.min_zoom = 0, .max_zoom = 16},
                 Console{Verbosity::quiet});
    std::size_t tiles = 0;
    for (const auto& entry : fs::recursive_directory_iterator{folder}) {
        const auto& path = entry.path();
        if (path.extension() != ".pbf") {
            continue;
        }
        const auto zoom = path.parent_path().parent_path().filename().string();
        const auto answer = served.ask(fmt::format("/tiles/WebMercatorQuad/{}/{}/{}",
                                                   zoom,
                                                   path.stem().string(),
                                                   path.parent_path().filename().string()));
        EXPECT_EQ(answer.status, 200) << path;
        EXPECT_EQ(answer.body, bytes_of(path)) << path;
        EXPECT_EQ(answer.headers.at("content-type"), "application/vnd.mapbox-vector-tile");
        ++tiles;
    }
    EXPECT_GE(tiles, 17U); // one of each zoom at least
}

TEST(OgcTiles, LetsTilesOfAVersionBeKeptForEver) {
    const ServedWorld served;
    auto address = tile_json_of(served).at("tiles")[0].get<std::string>();
    for (const auto& [word, value] : {std::pair{"{z}", "0"}, {"{y}", "0"}, {"{x}", "0"}}) {
        address.replace(address.find(word), 3, value);
    }
    const auto tile = served.ask(served.target_of(address), "Accept-Encoding: gzip\r\n");
    EXPECT_EQ(tile.status, 200);
    EXPECT_THAT(tile.headers.at("cache-control"), HasSubstr("immutable"));
    EXPECT_EQ(tile.headers.at("content-encoding"), "gzip");
    const auto other = served.ask("/tiles/WebMercatorQuad/0/0/0?v=old");
    EXPECT_EQ(other.headers.at("cache-control"), "no-cache");
    EXPECT_EQ(other.body, gunzipped(tile.body));
}

TEST(OgcTiles, SaysNothingInEmptyTiles) { // core/tc-success, B: 204
    const ServedWorld served;
    tile_json_of(served);
    const auto empty = served.ask("/tiles/WebMercatorQuad/16/0/0");
    EXPECT_EQ(empty.status, 204);
    EXPECT_TRUE(empty.body.empty());
}

TEST(OgcTiles, DrawsThePictureTilesThatExportsHave) { // png
    const ServedWorld served;
    const auto box = tile_json_of(served).at("bounds");
    const auto store = StoreReader::open(served.file);
    MapStyle style;
    style.classes = class_table(store.settings().class_table);
    TileSquarePainter painter{store, style, 256, 2048}; // another square than the server's
    const auto middle =
        tile_position({.lat_deg = (box[1].get<double>() + box[3].get<double>()) / 2,
                       .lon_deg = (box[0].get<double>() + box[2].get<double>()) / 2},
                      14);
    const TileId id{14, static_cast<std::uint32_t>(middle.x), static_cast<std::uint32_t>(middle.y)};
    std::size_t looked_at = 0, drawn = 0;
    painter.draw({{14, id.x / 8 * 8, id.y / 8 * 8}, {id.x / 8 * 8, id.y / 8 * 8, id.x, id.y}},
                 [&](const TileId& tile, const std::vector<std::uint8_t>& png) {
                     const auto answer = served.ask(
                         fmt::format("/map/tiles/WebMercatorQuad/14/{}/{}", tile.y, tile.x));
                     ++looked_at;
                     if (png == painter.empty()) {
                         EXPECT_EQ(answer.status, 204);
                         return;
                     }
                     ++drawn;
                     EXPECT_EQ(answer.status, 200) << answer.body;
                     EXPECT_EQ(answer.headers.at("content-type"), "image/png");
                     EXPECT_EQ(answer.body, std::string(png.begin(), png.end()));
                 });
    EXPECT_GE(looked_at, 1U);
    EXPECT_GE(drawn, 1U);
    const auto path = fmt::format("/tiles/WebMercatorQuad/14/{}/{}", id.y, id.x);
    EXPECT_EQ(served.ask(path + "?f=png").body, served.ask("/map" + path).body);
    EXPECT_EQ(served.ask(path + "?f=jpeg").status, 400);
    EXPECT_EQ(served.ask("/map" + path + "?f=mvt").status, 400);
    EXPECT_EQ(served.ask("/map/tiles/WebMercatorQuad/17/0/0").status, 404);
    const auto set = served.page("/map/tiles/WebMercatorQuad");
    EXPECT_EQ(set.at("dataType"), "map");
    EXPECT_EQ(set.at("links").back().at("type"), "image/png");
}

TEST(OgcTiles, DrawsNoMorePicturesAtOnceThanItMay) {
    const auto file = ServedWorld::new_file();
    PictureTiles pictures{file, Audience::anyone, Console{Verbosity::quiet}};
    constexpr std::size_t clients = PictureTiles::max_squares + 24;
    std::atomic<std::size_t> refused = 0, drawn = 0;
    {
        std::vector<std::jthread> asking;
        for (std::uint32_t i = 0; i < clients; ++i) {
            asking.emplace_back([&, i] { // each of another square
                const auto tile = pictures.tile("v", {16, 4 * i, 4 * i});
                ++(tile ? drawn : refused);
            });
        }
    }
    EXPECT_EQ(refused + drawn, clients);
    EXPECT_GE(drawn, 1U);
    EXPECT_TRUE(pictures.tile("v", {16, 0, 0})); // none is refused for ever
}

TEST(OgcTiles, DrawEachDirectionOnTheSideOfTraffic) {
    const auto file = test_folder() / "roads.gpkg";
    auto store = new_store(file);
    auto passes = passes_of(0);
    for (auto& pass : passes) {
        const int iri_um = pass.segment.forward ? 800 : 5000;
        pass.iri_left_um = pass.iri_right_um = pass.iri_um = iri_um;
    }
    add_trip(store, trip_record(0), passes);
    store.importer.refresh();
    const auto box = store.map_box();
    const auto middle = tile_position({.lat_deg = (box.south_deg + box.north_deg) / 2,
                                       .lon_deg = (box.west_deg + box.east_deg) / 2},
                                      14);
    const TileId id{14, static_cast<std::uint32_t>(middle.x), static_cast<std::uint32_t>(middle.y)};
    const Console quiet{Verbosity::quiet};
    PictureTiles right{file, Audience::anyone, quiet};
    PictureTiles left{file, Audience::anyone, quiet, true};
    const auto on_right = right.tile("v", id), on_left = left.tile("v", id);
    ASSERT_TRUE(on_right && *on_right && on_left && *on_left);
    EXPECT_NE(**on_right, **on_left);
}

TEST(OgcTiles, SaysOnceWhyItCannotDraw) {
    const auto file = test_folder() / "none.gpkg";
    PictureTiles pictures{file, Audience::anyone, Console{Verbosity::quiet}};
    EXPECT_FALSE(pictures.tile("v", {0, 0, 0}));
    new_store(file);
    EXPECT_TRUE(pictures.tile("v", {0, 0, 0})); // tries again
}

TEST(OgcTiles, RefusesTilesOutsideOfTheMatrix) { // core/tc-error
    const ServedWorld served;
    tile_json_of(served);
    for (const auto* path : {"0/0/1",
                             "0/1/0",
                             "17/0/0",
                             "-1/0/0",
                             "a/0/0",
                             "0/0/x",
                             "4294967296/0/0",
                             "3/8/0",
                             "3/0/8",
                             "0/0/0/0",
                             "40/0/0"}) {
        EXPECT_EQ(served.ask(fmt::format("/tiles/WebMercatorQuad/{}", path)).status, 404) << path;
    }
    EXPECT_EQ(served.ask("/tiles/WorldCRS84Quad/0/0/0").status, 404);
    EXPECT_EQ(served.ask("/tiles/WebMercatorQuad/0/0/0?x=1").status, 400);
}

TEST(OgcTiles, DescribesItsTileSets) { // tilesets-list, tileset, dataset- and geodata-tilesets
    const ServedWorld served;
    tile_json_of(served);
    for (const auto* place : {"/tiles", "/collections/segments/tiles"}) {
        const auto sets = served.page(place).at("tilesets");
        ASSERT_EQ(sets.size(), 1U);
        EXPECT_EQ(sets[0].at("dataType"), "vector");
        EXPECT_THAT(sets[0].at("tileMatrixSetURI").get<std::string>(),
                    HasSubstr("WebMercatorQuad"));
        EXPECT_EQ(served.page(std::string{place} + "/WebMercatorQuad"), sets[0]);
        EXPECT_EQ(sets[0].at("links").back().at("templated"), true);
    }
}

TEST(OgcTiles, DefinesTheMatrixSet) { // OGC 17-083r2, D.1
    const ServedWorld served;
    const auto set = served.follow(
        served.page("/tileMatrixSets").at("tileMatrixSets")[0].at("links")[0].at("href"));
    ASSERT_EQ(set.at("tileMatrices").size(), 17U);
    const auto& first = set.at("tileMatrices")[0];
    EXPECT_NEAR(first.at("scaleDenominator").get<double>(), 559082264.028717, 1e-5);
    EXPECT_NEAR(first.at("cellSize").get<double>(), 156543.033928041, 1e-8);
    EXPECT_EQ(set.at("tileMatrices")[16].at("matrixWidth"), 65536);
}

TEST(OgcTiles, AreReadByGdal) {
    const ServedWorld served;
    tile_json_of(served);
    const auto file = written(
        served.file.parent_path(), "0.pbf", served.ask("/tiles/WebMercatorQuad/0/0/0").body);
    EXPECT_THAT(
        output_of(file.parent_path(), fmt::format("ogrinfo -ro -so {} roughness", file.string())),
        HasSubstr("Feature Count: "));
}

TEST(OgcTiles, ShowsTheMapWhereTheProgramHasThePage) {
    const ServedWorld served;
    tile_json_of(served);
    const auto answer = served.ask("/", "Accept: text/html\r\n");
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.headers.at("content-type"), "text/html; charset=utf-8");
}

TEST(OgcTiles, ShowTheMapWithItsTitleAndSideOfTraffic) {
    if (!refusal_of([] { static_cast<void>(site_page_folder()); }).empty()) {
        return; // this build has no page
    }
    const ServedWorld served{{.port = 0}, {}, {}, {.title = "Our roads", .left_hand = true}};
    while (served.ask("/site.json").status == 404) { // the test's time limit ends it
        std::this_thread::sleep_for(std::chrono::milliseconds{50});
    }
    const auto site = served.page("/site.json");
    EXPECT_EQ(site.at("title"), "Our roads");
    EXPECT_EQ(site.at("left_hand"), true);
}

TEST(OgcTiles, AreTakenDownOnceOnlyPublicationsMayBeShown) {
    const ServedWorld served;
    const auto layers = tile_json_of(served);
    const auto bounds = layers.at("bounds");
    RoadStore::open(served.file).maintenance.make_crowd();
    const auto shows_old = [&] {
        const auto answer = served.ask("/tiles.json");
        return answer.status == 200 && nlohmann::json::parse(answer.body).at("bounds") == bounds;
    };
    while (shows_old()) { // the test's time limit ends it
        std::this_thread::sleep_for(std::chrono::milliseconds{100});
    }
    EXPECT_NE(tile_json_of(served).at("bounds"), bounds); // the empty map's
    EXPECT_EQ(served.ask("/site.json").status, 404);
}

} // namespace
} // namespace macadam::testing
