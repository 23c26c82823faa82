#include "storage/files/gzip.hpp"
#include "storage/tiles/tile_archive.hpp"

#include "support/files/files.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <set>
#include <stop_token>
#include <unistd.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::StartsWith;

TileSetNote note_of(TileSetNote::Format format) {
    return {.name = "Krems",
            .description = "Roughness (IRI, mm/m)",
            .attribution = "© OpenStreetMap contributors",
            .format = format,
            .bounds = {15.5, 48.375, 15.75, 48.5},
            .min_zoom = 0,
            .max_zoom = 14,
            .layers = {{"roughness", "about 20 m of road", 6, 14, {{"iri", "Number"}}}},
            .tile_px = 512};
}

constexpr auto mvt = TileSetNote::Format::mvt;
constexpr auto png = TileSetNote::Format::png;

std::string content_of(const fs::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

/// Of files below a folder.
std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator{folder}) {
        if (entry.is_regular_file()) {
            names.insert(fs::relative(entry.path(), folder).string());
        }
    }
    return names;
}

/// A folder of two tiles with the same content and one of its own.
void make_tiles(const fs::path& place, TileSetNote::Format format) {
    TileArchive archive{place, note_of(format)};
    archive.add({14, 8900, 5680}, gzipped("street"));
    archive.add({0, 0, 0}, gzipped("sea"));
    archive.add({14, 8901, 5680}, gzipped("sea"));
    const auto size = archive.commit();
    EXPECT_EQ(size.tiles, 3U);
    EXPECT_EQ(size.contents, 2U);
}

TEST(TileFolder, HasEachTileAsAFileOfItsOwn) {
    const auto place = test_folder() / "tiles/";
    make_tiles(place, png);
    EXPECT_THAT(names_in(place),
                ElementsAre("0/0/0.png", "14/8900/5680.png", "14/8901/5680.png", "metadata.json"));
    EXPECT_EQ(content_of(place / "14/8900/5680.png"), gzipped("street")); // as it was given
    EXPECT_EQ(content_of(place / "14/8901/5680.png"), gzipped("sea"));
}

TEST(TileFolder, HasVectorTilesAsServersHandThemOutThatKnowNothingOfGzip) {
    const auto place = test_folder() / "tiles/";
    make_tiles(place, mvt);
    EXPECT_THAT(names_in(place),
                ElementsAre("0/0/0.pbf", "14/8900/5680.pbf", "14/8901/5680.pbf", "metadata.json"));
    EXPECT_EQ(content_of(place / "14/8900/5680.pbf"), "street");
    EXPECT_EQ(content_of(place / "0/0/0.pbf"), "sea");
}

TEST(TileFolder, SaysWhatItsTilesAreAsTileJson) {
    const auto folder = test_folder();
    make_tiles(folder / "vector/", mvt);
    const auto vector = json::parse(content_of(folder / "vector/metadata.json"));
    EXPECT_EQ(vector, json::parse(R"json({
        "tilejson": "3.0.0", "name": "Krems", "description": "Roughness (IRI, mm/m)",
        "attribution": "© OpenStreetMap contributors", "scheme": "xyz",
        "tiles": ["{z}/{x}/{y}.pbf"], "minzoom": 0, "maxzoom": 14,
        "bounds": [15.5, 48.375, 15.75, 48.5], "center": [15.625, 48.4375, 11],
        "vector_layers": [{"id": "roughness", "description": "about 20 m of road",
                           "minzoom": 6, "maxzoom": 14, "fields": {"iri": "Number"}}]
    })json"));
    make_tiles(folder / "pictures/", png);
    const auto pictures = json::parse(content_of(folder / "pictures/metadata.json"));
    EXPECT_EQ(pictures["tiles"], json::parse(R"(["{z}/{x}/{y}.png"])"));
    EXPECT_EQ(pictures["tileSize"], 512);
    EXPECT_FALSE(pictures.contains("vector_layers"));
}

TEST(TileFolder, FillsAnEmptyFolderThatIsThere) {
    const auto place = test_folder() / "tiles";
    fs::create_directory(place);
    EXPECT_TRUE(is_tile_folder(place)); // without a slash, too
    make_tiles(place, png);
    EXPECT_THAT(names_in(place),
                ElementsAre("0/0/0.png", "14/8900/5680.png", "14/8901/5680.png", "metadata.json"));
}

TEST(TileFolder, IsSaidByASlashOrAFolderThatIsThere) {
    const auto folder = test_folder();
    EXPECT_TRUE(is_tile_folder(folder / "new/"));
    EXPECT_FALSE(is_tile_folder(folder / "new"));
    EXPECT_FALSE(is_tile_folder(folder / "new.mbtiles"));
    fs::create_directory(folder / "a.mbtiles");
    EXPECT_FALSE(is_tile_folder(folder / "a.mbtiles"));
}

TEST(TileFolder, AppearsWholeOrNotAtAll) {
    const auto folder = test_folder();
    fs::create_directory(folder / "there");
    for (const auto* name : {"new/", "there"}) {
        {
            TileArchive archive{folder / name, note_of(mvt)};
            archive.add({0, 0, 0}, gzipped("x"));
            EXPECT_FALSE(fs::exists(folder / "new"));
        }
        EXPECT_THAT(names_in(folder), ElementsAre()) << name;
        EXPECT_TRUE(fs::is_empty(folder / "there"));
        EXPECT_FALSE(fs::exists(folder / "new"));
    }
}

TEST(TileFolder, LeavesNothingWhenItIsStopped) {
    const auto folder = test_folder();
    std::stop_source stop;
    stop.request_stop();
    {
        TileArchive archive{folder / "tiles/", note_of(mvt)};
        archive.add({0, 0, 0}, gzipped("x"));
        EXPECT_EQ(refusal_of([&] {
                      archive.commit({{}, stop.get_token()});
                  }),
                  "stopped before the folder was complete");
    }
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST(TileFolder, RefusesAFolderThatHasSomethingInIt) {
    const auto folder = test_folder();
    written(folder, "tiles/9/1/2.png", "older");
    EXPECT_EQ(refusal_of([&] {
                  TileArchive{folder / "tiles/", note_of(png)};
              }),
              (folder / "tiles").string() + ": is not empty, expected a new or an empty folder");
    EXPECT_EQ(content_of(folder / "tiles/9/1/2.png"), "older");
    written(folder, "file", "");
    EXPECT_THAT(refusal_of([&] {
                    TileArchive{folder / "file/", note_of(png)};
                }),
                StartsWith((folder / "file").string() + ": "));
}

TEST(TileFolder, NamesTheTileThatCannotBeWritten) {
    const auto folder = test_folder();
    {
        TileArchive archive{folder / "tiles/", note_of(png)};
        archive.add({14, 8900, 5680}, "x");
        const auto part = fs::directory_iterator {
            folder
            } -> path();
        EXPECT_THAT(part.filename().string(), StartsWith("tiles.part-"));
        written(part / "content", "14/8900", "in the way");
        EXPECT_EQ(refusal_of([&] { archive.commit(); }),
                  (folder / "tiles/14/8900").string() + ": cannot be written: Not a directory");
    }
    EXPECT_TRUE(fs::is_empty(folder));
}

} // namespace
} // namespace macadam::testing
