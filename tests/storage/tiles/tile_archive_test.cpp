#include "storage/tiles/tile_archive.hpp"

#include "storage/files/gzip.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/tiles/tile_index.hpp"
#include "support/files/files.hpp"
#include "support/files/pmtiles_reader.hpp"
#include "support/files/views.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>
#include <random>
#include <set>

namespace macadam::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

std::string content_of(const std::filesystem::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

std::string output_of(const std::filesystem::path& folder, const std::string& command) {
    const auto log = folder / "output.txt";
    const int status = std::system((command + " >" + log.string() + " 2>&1").c_str());
    return content_of(log) + (status == 0 ? "" : "\nexit " + std::to_string(status));
}

TileSetNote note_of(TileSetNote::Format format) {
    return {.name = "Krems",
            .description = "Roughness (IRI, mm/m)",
            .attribution = "© OpenStreetMap contributors",
            .format = format,
            .bounds = {15.5, 48.375, 15.75, 48.5},
            .min_zoom = 0,
            .max_zoom = 14,
            .layers = {{"roughness", "about 20 m of road", 6, 14, {{"iri", "Number"}}}}};
}

constexpr auto mvt = TileSetNote::Format::mvt;
constexpr auto png = TileSetNote::Format::png;

/// Content that says where it lies.
std::string named(const TileId& tile) {
    return gzipped("tile " + std::to_string(tile.zoom) + " " + std::to_string(tile.x) + " " +
                   std::to_string(tile.y));
}

std::vector<TileId> square(std::uint8_t zoom, std::uint32_t first, std::uint32_t side) {
    std::vector<TileId> tiles;
    for (std::uint32_t y = first; y < first + side; ++y) {
        for (std::uint32_t x = first; x < first + side; ++x) {
            tiles.push_back({zoom, x, y});
        }
    }
    return tiles;
}

// ------------------------------------------------------------------------------------- numbers

// The specification's own table (4.1.1).
TEST(TileNumber, IsThatOfTheSpecificationsExamples) {
    EXPECT_EQ(tile_number({0, 0, 0}), 0U);
    EXPECT_EQ(tile_number({1, 0, 0}), 1U);
    EXPECT_EQ(tile_number({1, 0, 1}), 2U);
    EXPECT_EQ(tile_number({1, 1, 1}), 3U);
    EXPECT_EQ(tile_number({1, 1, 0}), 4U);
    EXPECT_EQ(tile_number({2, 0, 0}), 5U);
    EXPECT_EQ(tile_number({12, 3423, 1763}), 19'078'479U);
}

TEST(TileNumber, GoesFromEachTileToANeighbour) {
    std::map<std::uint64_t, TileId> by_number;
    for (const auto& tile : square(6, 0, 64)) {
        by_number.emplace(tile_number(tile), tile);
    }
    ASSERT_EQ(by_number.size(), 64U * 64U);
    ASSERT_EQ(by_number.rbegin()->first - by_number.begin()->first + 1, by_number.size());
    for (auto tile = by_number.begin(), next = std::next(tile); next != by_number.end();
         ++tile, ++next) {
        const auto apart = std::abs(int(next->second.x) - int(tile->second.x)) +
                           std::abs(int(next->second.y) - int(tile->second.y));
        ASSERT_EQ(apart, 1) << tile->first;
    }
}

// ------------------------------------------------------------------------------------- PMTiles

TEST(PmTiles, HoldEveryTileThatWasAdded) {
    const auto file = test_folder() / "a.pmtiles";
    TileArchive archive{file, note_of(mvt)};
    const auto tiles = square(9, 100, 20);
    for (const auto& tile : tiles) {
        archive.add(tile, named(tile));
    }
    EXPECT_EQ(archive.commit().tiles, tiles.size());
    const auto read = read_pmtiles(file);
    EXPECT_EQ(read.tiles.size(), tiles.size());
    for (const auto& tile : tiles) {
        EXPECT_EQ(read.tiles.at(tile), named(tile));
    }
    EXPECT_EQ(read.addressed_tiles, tiles.size());
    EXPECT_EQ(read.contents, tiles.size());
    EXPECT_EQ(read.leaves, 0U);
}

TEST(PmTiles, SayWhatTheyAreInTheirHeader) {
    const auto file = test_folder() / "a.pmtiles";
    TileArchive archive{file, note_of(mvt)};
    archive.add({14, 8900, 5680}, gzipped("x"));
    archive.commit();
    const auto read = read_pmtiles(file);
    EXPECT_TRUE(read.clustered);
    EXPECT_EQ(read.tile_compression, 2); // gzip
    EXPECT_EQ(read.tile_type, 1);        // MVT
    EXPECT_EQ(read.min_zoom, 0);
    EXPECT_EQ(read.max_zoom, 14);
    EXPECT_EQ(read.west_deg, 15.5);
    EXPECT_EQ(read.south_deg, 48.375);
    EXPECT_EQ(read.east_deg, 15.75);
    EXPECT_EQ(read.north_deg, 48.5);
    EXPECT_EQ(read.centre_zoom, 11); // 0.25 degrees of 360 are 1.4 tiles there
    const auto metadata = json::parse(read.metadata);
    EXPECT_EQ(metadata["attribution"], "© OpenStreetMap contributors");
    EXPECT_EQ(metadata["vector_layers"][0]["id"], "roughness");
    EXPECT_EQ(metadata["vector_layers"][0]["fields"]["iri"], "Number");
    EXPECT_EQ(metadata["vector_layers"][0]["minzoom"], 6);
}

TEST(PmTiles, OfPicturesAreNotCompressedAgain) {
    const auto file = test_folder() / "a.pmtiles";
    auto note = note_of(png);
    note.layers.clear();
    TileArchive archive{file, note};
    archive.add({0, 0, 0}, grey_png(4, 7));
    archive.commit();
    const auto read = read_pmtiles(file);
    EXPECT_EQ(read.tile_compression, 1); // none
    EXPECT_EQ(read.tile_type, 2);        // PNG
    EXPECT_EQ(read.tiles.at({0, 0, 0}), grey_png(4, 7));
    EXPECT_FALSE(json::parse(read.metadata).contains("vector_layers"));
}

TEST(PmTiles, KeepTheRootInTheFirst16KilobytesHoweverManyTiles) {
    const auto file = test_folder() / "a.pmtiles";
    TileArchive archive{file, note_of(mvt)};
    std::mt19937 random{5};
    std::map<TileId, std::string> added; // far apart and of many sizes, so that little compresses
    while (added.size() < 30'000) {
        const TileId tile{14, std::uint32_t(random() % 16384), std::uint32_t(random() % 16384)};
        const std::string content(1 + random() % 300, char('a' + random() % 26));
        if (added.emplace(tile, content + named(tile)).second) {
            archive.add(tile, added.at(tile));
        }
    }
    archive.commit();
    const auto read = read_pmtiles(file);
    EXPECT_LE(read.root_ends_at, 16384U);
    EXPECT_GT(read.leaves, 1U);
    EXPECT_EQ(read.tiles, added);
}

TEST(PmTiles, StoreWhatIsAlikeOnceAndTellItInRuns) {
    const auto file = test_folder() / "a.pmtiles";
    TileArchive archive{file, note_of(mvt)};
    const auto sea = gzipped("sea");
    for (const auto& tile : square(5, 0, 32)) {
        archive.add(tile, tile.x == 7 && tile.y == 9 ? gzipped("island") : sea);
    }
    const auto size = archive.commit();
    EXPECT_EQ(size.tiles, 1024U);
    EXPECT_EQ(size.contents, 2U);
    EXPECT_EQ(size.bytes, sea.size() + gzipped("island").size());
    const auto read = read_pmtiles(file);
    EXPECT_EQ(read.addressed_tiles, 1024U);
    EXPECT_EQ(read.entries, 3U); // before the island, it, after it
    EXPECT_EQ(read.contents, 2U);
    EXPECT_EQ(read.tiles.size(), 1024U);
    EXPECT_EQ(read.tiles.at({5, 7, 9}), gzipped("island"));
}

// ------------------------------------------------------------------------------------- MBTiles

TEST(MbTiles, HoldEveryTileInARowCountedFromTheSouth) {
    const auto file = test_folder() / "a.mbtiles";
    TileArchive archive{file, note_of(mvt)};
    const auto tiles = square(9, 100, 20);
    for (const auto& tile : tiles) {
        archive.add(tile, named(tile));
    }
    archive.commit();
    Database database{file, Database::Access::read};
    show_views_of(database);
    EXPECT_EQ(database.number("SELECT count(*) FROM tiles"), std::int64_t(tiles.size()));
    auto select = database.prepare("SELECT tile_data FROM tiles WHERE zoom_level = ?"
                                   " AND tile_column = ? AND tile_row = ?");
    for (const auto& tile : tiles) {
        ASSERT_TRUE(select.bind(9, int(tile.x), 511 - int(tile.y)).step());
        EXPECT_EQ(select.blob(0), named(tile));
    }
}

TEST(MbTiles, SayWhatTheyAre) {
    const auto file = test_folder() / "a.mbtiles";
    TileArchive archive{file, note_of(mvt)};
    archive.add({14, 8900, 5680}, gzipped("x"));
    archive.commit();
    Database database{file, Database::Access::read};
    EXPECT_EQ(database.number("PRAGMA application_id"), 0x4d504258); // "MPBX"
    std::map<std::string, std::string> metadata;
    auto select = database.prepare("SELECT name, value FROM metadata");
    while (select.step()) {
        metadata.emplace(select.text(0), select.text(1));
    }
    EXPECT_EQ(metadata.at("name"), "Krems");
    EXPECT_EQ(metadata.at("format"), "pbf");
    EXPECT_EQ(metadata.at("bounds"), "15.5000000,48.3750000,15.7500000,48.5000000");
    EXPECT_EQ(metadata.at("center"), "15.6250000,48.4375000,11");
    EXPECT_EQ(metadata.at("minzoom"), "0");
    EXPECT_EQ(metadata.at("maxzoom"), "14");
    EXPECT_EQ(metadata.at("attribution"), "© OpenStreetMap contributors");
    EXPECT_EQ(json::parse(metadata.at("json"))["vector_layers"][0]["id"], "roughness");
}

TEST(MbTiles, StoreWhatIsAlikeOnce) {
    const auto file = test_folder() / "a.mbtiles";
    TileArchive archive{file, note_of(mvt)};
    for (const auto& tile : square(5, 0, 32)) {
        archive.add(tile, gzipped("sea"));
    }
    archive.commit();
    Database database{file, Database::Access::read};
    show_views_of(database);
    EXPECT_EQ(database.number("SELECT count(*) FROM tiles"), 1024);
    EXPECT_EQ(database.number("SELECT count(*) FROM images"), 1);
}

TEST(MbTiles, OfPicturesAreReadByGdalWhereTheyLie) {
    const auto folder = test_folder();
    auto note = note_of(png);
    note.layers.clear();
    note.bounds.east_deg = 16; // beyond which GDAL shows nothing
    note.min_zoom = note.max_zoom = 10;
    const auto place = tile_position({48.4375, 15.625}, 10);
    const TileId middle{10, std::uint32_t(place.x), std::uint32_t(place.y)};
    TileArchive archive{folder / "a.mbtiles", note};
    archive.add(middle, grey_png(256, 77));
    archive.add({10, middle.x + 1, middle.y}, grey_png(256, 133));
    archive.commit();
    const auto grey_at = [&](double lon_deg) {
        return output_of(folder,
                         "gdallocationinfo -valonly -b 1 -wgs84 " +
                             (folder / "a.mbtiles").string() + " " + std::to_string(lon_deg) +
                             " 48.4375");
    };
    EXPECT_EQ(grey_at(15.625), "77\n");
    EXPECT_EQ(grey_at(geo_point({middle.x + 1.1, place.y}, 10).lon_deg), "133\n");
}

// ----------------------------------------------------------------------------------------- both

TEST(TileArchive, IsTheSameToTheLastByteInWhateverOrderTilesCome) {
    const auto folder = test_folder();
    auto tiles = square(8, 40, 30);
    std::mt19937 random{3};
    for (const auto* suffix : {".mbtiles", ".pmtiles"}) {
        const auto written_in_order = [&](const std::string& name) {
            TileArchive archive{folder / (name + suffix), note_of(mvt)};
            for (const auto& tile : tiles) {
                archive.add(tile, gzipped(std::to_string(tile.x % 7))); // many alike
            }
            archive.commit();
            return content_of(folder / (name + suffix));
        };
        const auto first = written_in_order("first");
        std::ranges::shuffle(tiles, random);
        EXPECT_TRUE(written_in_order("second") == first) << suffix;
    }
}

TEST(TileArchive, AppearsWholeOrNotAtAll) {
    const auto folder = test_folder();
    for (const auto* name : {"a.mbtiles", "a.pmtiles"}) {
        {
            TileArchive archive{folder / name, note_of(mvt)};
            archive.add({0, 0, 0}, gzipped("x"));
            EXPECT_FALSE(std::filesystem::exists(folder / name));
        }
        EXPECT_TRUE(std::filesystem::is_empty(folder)) << name;
    }
}

TEST(TileArchive, TakesTheNameOfAnOlderOne) {
    const auto folder = test_folder();
    for (const auto* name : {"a.mbtiles", "a.pmtiles"}) {
        written(folder, name, "older");
        TileArchive archive{folder / name, note_of(mvt)};
        archive.add({0, 0, 0}, gzipped("x"));
        archive.commit();
        EXPECT_NE(content_of(folder / name), "older");
    }
}

TEST(TileArchive, RefusesWhatItCannotBe) {
    const auto folder = test_folder();
    EXPECT_EQ(refusal_of([&] {
                  TileArchive{folder / "a.zip", note_of(mvt)};
              }),
              (folder / "a.zip").string() +
                  ": suffix '.zip', expected .mbtiles, .pmtiles or a folder, as in tiles/");
    EXPECT_EQ(refusal_of([&] {
                  TileArchive{folder / "none" / "a.pmtiles", note_of(mvt)};
              }),
              (folder / "none" / "a.pmtiles").string() +
                  ": cannot be written: No such file or directory");
    EXPECT_EQ(refusal_of([&] {
                  TileArchive{folder / "a.pmtiles", note_of(mvt)}.commit();
              }),
              (folder / "a.pmtiles").string() + ": there are no tiles, expected at least one");
}

TEST(TileArchive, LeavesNothingWhenItIsStopped) {
    const auto folder = test_folder();
    std::stop_source stop;
    stop.request_stop();
    for (const auto* name : {"a.mbtiles", "a.pmtiles"}) {
        {
            TileArchive archive{folder / name, note_of(mvt)};
            archive.add({0, 0, 0}, gzipped("x"));
            EXPECT_EQ(refusal_of([&] {
                          archive.commit({{}, stop.get_token()});
                      }),
                      "stopped before the file was complete");
        }
        EXPECT_TRUE(std::filesystem::is_empty(folder)) << name;
    }
}

TEST(Gzip, ComesBackAsItWas) {
    std::mt19937 random{1};
    for (const std::size_t size : {0U, 1U, 100U, 100'000U}) {
        std::string bytes(size, ' ');
        for (auto& byte : bytes) {
            byte = static_cast<char>(random() % 20);
        }
        EXPECT_EQ(unzipped(gzipped(bytes)), bytes);
        EXPECT_EQ(gunzipped(gzipped(bytes)), bytes);
    }
}

} // namespace
} // namespace macadam::testing
