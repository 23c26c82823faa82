#include "app/tiles/tile_pyramid.hpp"

#include "app/cli/commands.hpp"
#include "app/export/tile_export.hpp"
#include "mapping/tiles/tile_generalisation.hpp"
#include "render/tiles/mvt_tile.hpp"
#include "storage/files/gzip.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "support/files/files.hpp"
#include "support/files/pmtiles_reader.hpp"
#include "support/files/vector_tile_reader.hpp"
#include "support/files/views.hpp"
#include "support/roads/store_world.hpp"
#include "support/roads/tile_town.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>

namespace macadam::testing {
namespace {

using Tiles = std::map<TileId, std::string>; // gzipped

const ClassTable& fhwa = *class_table("fhwa");

struct Made {
    Tiles tiles;
    TileCount count;
    std::vector<TileSegment> segments;
};

Made make(const TilePlan& plan, std::size_t streets = 150) {
    TileSource source{test_folder() / "tiles"};
    Made made;
    made.segments = tile_town(source.words, streets);
    for (const auto& segment : made.segments) {
        add(source, segment);
    }
    source.segments.settle();
    made.count = make_vector_tiles(source,
                                   fhwa,
                                   plan,
                                   [&](const TileId& tile, std::string_view bytes) {
                                       EXPECT_TRUE(made.tiles.emplace(tile, bytes).second);
                                   },
                                   {});
    return made;
}

std::int64_t whole(const ReadFeature& feature, const char* key) {
    return std::get<std::int64_t>(feature.values.at(key));
}

/// The features of a zoom by their numbers. One that lies in several tiles must say the same in
/// all.
std::map<std::uint64_t, ReadFeature> features_of(const Tiles& tiles, int zoom) {
    std::map<std::uint64_t, ReadFeature> features;
    for (const auto& [tile, bytes] : tiles) {
        if (tile.zoom != zoom) {
            continue;
        }
        for (const auto& feature : read_vector_tile(unzipped(bytes)).features) {
            const auto& known = features.emplace(feature.id.value(), feature).first->second;
            EXPECT_EQ(known.values, feature.values) << zoom;
        }
    }
    return features;
}

std::vector<double> lengths_of(const std::map<std::uint64_t, ReadFeature>& features) {
    std::vector<double> lengths(fhwa.classes.size(), 0);
    for (const auto& [id, feature] : features) {
        bool is_mixed = false;
        for (std::size_t i = 0; i < lengths.size(); ++i) {
            const auto key = std::string{fhwa.classes[i].name} + "_m";
            if (feature.values.contains(key)) {
                lengths[i] += double(whole(feature, key.c_str()));
                is_mixed = true;
            }
        }
        if (!is_mixed) {
            const auto name = std::get<std::string>(feature.values.at("class"));
            const auto found = std::ranges::find(fhwa.classes, name, &IriClass::name);
            lengths[std::size_t(found - fhwa.classes.begin())] +=
                double(whole(feature, "length_m"));
        }
    }
    return lengths;
}

std::vector<double> lengths_of(const std::vector<TileSegment>& segments) {
    std::vector<double> lengths(fhwa.classes.size(), 0);
    for (const auto& segment : segments) {
        lengths[class_index(fhwa, segment.state.iri_um / 1000.0)] += segment.to_m - segment.from_m;
    }
    return lengths;
}

/// Every segment is 20 m and every feature counts whole segments, so nothing is rounded.
TEST(TilePyramid, HasEveryMeasuredMetreOfEveryClassOnceAtEveryZoomOfParts) {
    const auto made = make({.min_zoom = 3, .max_zoom = 13});
    for (int zoom = 3; zoom <= 13; ++zoom) {
        EXPECT_EQ(lengths_of(features_of(made.tiles, zoom)), lengths_of(made.segments)) << zoom;
    }
    EXPECT_EQ(made.count.coarsened, 0U);
    EXPECT_LT(features_of(made.tiles, 6).size(), 150U);
}

TEST(TilePyramid, HasEverySegmentOnceAtEveryZoomOfSegments) {
    const auto made = make({.min_zoom = 14, .max_zoom = 16});
    std::set<std::uint64_t> expected;
    for (const auto& segment : made.segments) {
        expected.insert(*feature_id(segment.state.segment));
    }
    for (int zoom = 14; zoom <= 16; ++zoom) {
        std::set<std::uint64_t> found;
        for (const auto& [id, feature] : features_of(made.tiles, zoom)) {
            found.insert(id);
        }
        EXPECT_EQ(found, expected) << zoom;
    }
}

TEST(TilePyramid, ShowsASegmentInEveryTileThatItComesInto) {
    const auto made = make({.min_zoom = 16, .max_zoom = 16}, 60);
    std::map<TileId, std::set<std::uint64_t>> shown;
    for (const auto& [tile, bytes] : made.tiles) {
        for (const auto& feature : read_vector_tile(unzipped(bytes)).features) {
            shown[tile].insert(*feature.id);
        }
    }
    ASSERT_FALSE(made.segments.empty());
    for (const auto& segment : made.segments) {
        for (int step = 0; step <= 50; ++step) { // places along its straight line
            const auto &a = segment.line.front(), &b = segment.line.back();
            const double share = step / 50.0;
            const WorldPoint at{std::uint32_t(a.x + share * (double(b.x) - a.x)),
                                std::uint32_t(a.y + share * (double(b.y) - a.y))};
            ASSERT_TRUE(shown[tile_at(at, 16)].contains(*feature_id(segment.state.segment)));
        }
    }
}

TEST(TilePyramid, KeepsEveryTileUnderItsSizeAndStillEveryMetre) {
    constexpr std::uint64_t max_bytes = 3000; // so little that many must be coarsened
    const auto made = make({.min_zoom = 8, .max_zoom = 14, .jobs = 1, .max_bytes = max_bytes});
    EXPECT_GT(made.count.coarsened, 5U);
    EXPECT_GT(made.count.max_steps, 1);
    EXPECT_LE(made.count.largest_bytes, max_bytes);
    for (const auto& [tile, bytes] : made.tiles) {
        EXPECT_LE(bytes.size(), max_bytes);
    }
    for (int zoom = 8; zoom <= 13; ++zoom) {
        EXPECT_EQ(lengths_of(features_of(made.tiles, zoom)), lengths_of(made.segments)) << zoom;
    }
}

TEST(TilePyramid, IsTheSameForAnyNumberOfJobs) {
    EXPECT_TRUE(make({.jobs = 1}).tiles == make({.jobs = 4}).tiles);
}

TEST(TilePyramid, EndsWhenItIsStopped) {
    TileSource source{test_folder() / "tiles"};
    for (const auto& segment : tile_town(source.words, 20)) {
        add(source, segment);
    }
    source.segments.settle();
    std::stop_source stop;
    stop.request_stop();
    EXPECT_EQ(
        refusal_of([&] {
            make_vector_tiles(source, fhwa, {}, [](const TileId&, auto) {}, {{}, stop.get_token()});
        }),
        "stopped before the file was complete");
}

// --------------------------------------------------------------------------------------- export

TEST(TileExport, WritesWhatTheStoreHoldsIntoBothKinds) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 6);
    for (const auto* name : {"a.pmtiles", "a.mbtiles"}) {
        export_tiles(
            store, {}, folder / name, {.min_zoom = 12, .max_zoom = 15}, Console{Verbosity::quiet});
    }
    const auto read = read_pmtiles(folder / "a.pmtiles");
    std::map<std::string, std::int64_t> passes;
    for (const auto& [id, feature] : features_of(read.tiles, 15)) {
        passes[std::get<std::string>(feature.values.at("segment"))] = whole(feature, "passes");
    }
    std::map<std::string, std::int64_t> expected;
    store.visit({}, [&](const SegmentRecord& record) {
        expected[name_of(record.segment.key)] = record.state->passes;
    });
    EXPECT_EQ(passes, expected);

    Database database{folder / "a.mbtiles", Database::Access::read};
    testing::show_views_of(database);
    EXPECT_EQ(database.number("SELECT count(*) FROM tiles"), std::int64_t(read.tiles.size()));
    auto select = database.prepare("SELECT tile_data FROM tiles WHERE zoom_level = ?"
                                   " AND tile_column = ? AND tile_row = ?");
    for (const auto& [tile, bytes] : read.tiles) {
        const auto row = (1 << tile.zoom) - 1 - int(tile.y);
        ASSERT_TRUE(select.bind(int{tile.zoom}, int(tile.x), row).step());
        EXPECT_EQ(select.blob(0), bytes);
    }
}

TEST(TileExport, WritesTheSameTilesIntoAFolder) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 6);
    for (const auto* name : {"tiles/", "a.pmtiles"}) {
        export_tiles(
            store, {}, folder / name, {.min_zoom = 12, .max_zoom = 15}, Console{Verbosity::quiet});
    }
    const auto read = read_pmtiles(folder / "a.pmtiles");
    for (const auto& [tile, bytes] : read.tiles) {
        std::ifstream in{folder / "tiles" / std::to_string(tile.zoom) / std::to_string(tile.x) /
                             (std::to_string(tile.y) + ".pbf"),
                         std::ios::binary};
        ASSERT_TRUE(in.is_open());
        const std::string plain{std::istreambuf_iterator<char>{in}, {}};
        EXPECT_TRUE(gzipped(plain) == bytes);
    }
    const auto files = std::filesystem::recursive_directory_iterator{folder / "tiles"};
    EXPECT_EQ(std::ranges::count_if(files, [](auto& entry) { return entry.is_regular_file(); }),
              std::ptrdiff_t(read.tiles.size()) + 1); // and metadata.json
}

TEST(TileExport, TakesNoFolderForAFileOfSegments) {
    const auto folder = test_folder();
    std::filesystem::create_directory(folder / "roads.csv");
    EXPECT_FALSE(is_tile_archive(folder / "roads.csv"));
    EXPECT_TRUE(is_tile_archive(folder / "roads.csv/"));
    EXPECT_TRUE(is_tile_archive(folder / "roads.pmtiles"));
}

TEST(TileExport, RefusesAFolderWithSomethingInItBeforeItReadsTheStore) {
    const auto folder = test_folder();
    const auto store = new_store(folder / "a.gpkg"); // in which nothing was measured
    EXPECT_EQ(
        refusal_of([&] { export_tiles(store, {}, folder / "", {}, Console{Verbosity::quiet}); }),
        folder.string() + ": is not empty, expected a new or an empty folder");
}

TEST(TileExport, IntoAFolderIsReadByGdal) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 6);
    export_tiles(
        store, {}, folder / "tiles/", {.min_zoom = 12, .max_zoom = 14}, Console{Verbosity::quiet});
    const auto command = "ogr2ogr -f CSV -select segment " + (folder / "a.csv").string() + " " +
                         (folder / "tiles/14").string();
    ASSERT_EQ(std::system(command.c_str()), 0);
    std::ifstream in{folder / "a.csv"};
    std::set<std::string> found;
    for (std::string line; std::getline(in, line);) {
        found.insert(line.substr(0, line.find(',')));
    }
    found.erase("segment");
    std::set<std::string> expected;
    store.visit({},
                [&](const SegmentRecord& record) { expected.insert(name_of(record.segment.key)); });
    EXPECT_EQ(found, expected);
}

TEST(TileExport, IsReadByGdal) {
    const auto folder = test_folder();
    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 6);
    export_tiles(store,
                 {},
                 folder / "a.mbtiles",
                 {.min_zoom = 12, .max_zoom = 14},
                 Console{Verbosity::quiet});
    const auto command = "ogr2ogr -f CSV -oo ZOOM_LEVEL=14 -select segment,iri " +
                         (folder / "a.csv").string() + " " + (folder / "a.mbtiles").string();
    ASSERT_EQ(std::system(command.c_str()), 0);
    std::ifstream in{folder / "a.csv"};
    std::map<std::string, double> found;
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "segment,iri");
    while (std::getline(in, line)) {
        found[line.substr(0, line.find(','))] = std::stod(line.substr(line.find(',') + 1));
    }
    std::size_t segments = 0;
    store.visit({}, [&](const SegmentRecord& record) {
        const auto name = name_of(record.segment.key);
        ASSERT_TRUE(found.contains(name)) << name;
        EXPECT_NEAR(found.at(name), record.state->iri_um / 1000.0, 0.00501); // of two decimals
        ++segments;
    });
    EXPECT_EQ(found.size(), segments);
}

TEST(TileExport, AsksForASegmentToShow) {
    const auto folder = test_folder();
    const auto store = new_store(folder / "a.gpkg");
    EXPECT_EQ(refusal_of([&] {
                  export_tiles(store, {}, folder / "a.pmtiles", {}, Console{Verbosity::quiet});
              }),
              (folder / "a.gpkg").string() +
                  ": the selection contains no measured segment, expected at least one");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.pmtiles"));
}

std::string misuse_of(const std::vector<std::string>& words) {
    try {
        run(*command_named("export"), words);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(TileExport, RefusesOptionsThatDoNotFit) {
    for (const auto* zooms : {"16-6", "-1", "6-19", "6-", "a", "6-7-8", "6-16x"}) {
        EXPECT_EQ(misuse_of({"a.gpkg", "-o", "a.pmtiles", std::string{"--zoom="} + zooms}),
                  std::string{"--zoom is '"} + zooms +
                      "', expected one or two of 0 to 18, as in 6-16");
    }
    EXPECT_EQ(misuse_of({"a.gpkg", "-o", "a.mbtiles", "--jobs", "0"}),
              "--jobs is 0, expected 1 to 256");
    EXPECT_EQ(misuse_of({"a.gpkg", "-o", "a.csv", "--zoom", "6-9"}),
              "--zoom and --jobs are for tile output, expected -o to end in .mbtiles, .pmtiles "
              "or /");
}

} // namespace
} // namespace macadam::testing
