#include "app/export/raster_tiles.hpp"

#include "app/cli/commands.hpp"
#include "app/export/tile_line_merging.hpp"
#include "estimator/common/error.hpp"
#include "render/tiles/tile_painter.hpp"
#include "render/tiles/tile_png.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"
#include "support/roads/town.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stop_token>
#include <thread>

#include <unistd.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

using Tiles = std::map<TileId, std::string>;

/// A town of some 700 m with passes on four of five segments.
fs::path town_store() {
    const auto file = test_folder() / "town.gpkg";
    const auto roads = made_up_town(7);
    auto store = RoadStore::create(file, roads, {});
    std::vector<Pass> passes;
    for (std::uint32_t i = 0; i < link_count(roads); ++i) {
        for (const bool forward : {true, false}) {
            const auto edge = edge_of(LinkId{i}, forward);
            if (!is_drivable(roads, edge)) {
                continue;
            }
            for (const auto& segment : segments_of(roads, edge)) {
                const auto number = static_cast<IriUm>(passes.size());
                if (segment.key.index % 5 == 4) {
                    continue;
                }
                const IriUm um = 800 + number / 3 * 977 % 2700;
                passes.push_back({.segment = segment.key,
                                  .occurrence = 0,
                                  .iri_left_um = {},
                                  .iri_right_um = {},
                                  .iri_centre_um = um,
                                  .iri_um = um,
                                  .sd_um = um / (number % 3 == 0 ? 1 : 5),
                                  .centre_only = true,
                                  .validity = 0,
                                  .speed_mmps = 14000,
                                  .covered_mm = 20000,
                                  .confidence_ppm = 990000,
                                  .t_ms = 0});
            }
        }
    }
    TripRecord trip;
    trip.trip_id = "everywhere";
    trip.sha256 = std::string(64, '0');
    trip.vehicle_id = "car";
    add_trip(store, trip, passes);
    store.importer.refresh();
    return file;
}

PicturePlan plan_of(const fs::path& store, int min_zoom, int max_zoom) {
    PicturePlan plan;
    plan.min_zoom = min_zoom;
    plan.max_zoom = max_zoom;
    plan.box = StoreReader::open(store).info().box;
    plan.style.classes = class_table("fhwa");
    return plan;
}

Tiles drawn(const fs::path& store, const PicturePlan& plan) {
    Tiles tiles;
    PicturePainters{store, plan}.collect(
        [&](const TileId& tile, std::string_view bytes) {
            EXPECT_TRUE(tiles.emplace(tile, bytes).second);
        },
        {});
    return tiles;
}

/// A tile by itself, of the lines that the rules bring for it.
std::string alone(const StoreReader& store, const PicturePlan& plan, const TileId& tile) {
    TilePainter painter{{plan.style, plan.tile_px, 1}};
    TilePng png{plan.style};
    const auto rules = tile_line_rules(
        {tile.zoom, plan.tile_px}, store.settings().segment_length_m, painter.reach_px(tile.zoom));
    const auto lines = tile_lines(store, tile_box(tile), rules, *plan.style.classes);
    const auto bytes = png.encode(painter.draw(tile, lines), {0, 0, plan.tile_px});
    return {bytes.begin(), bytes.end()};
}

std::string misuse_of(const std::vector<std::string>& words) {
    try {
        run(*command_named("export"), words);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

} // namespace

TEST(PictureTiles, AreThoseThatAreDrawnEachForItselfFromTheStore) {
    const auto file = town_store();
    const auto plan = plan_of(file, 9, 17);
    auto plan_512 = plan;
    plan_512.tile_px = 512;
    const auto tiles = drawn(file, plan);
    const auto tiles_512 = drawn(file, plan_512);
    const auto store = StoreReader::open(file);
    ASSERT_FALSE(tiles.empty());
    for (const auto& [tile, png] : tiles) {
        EXPECT_TRUE(png == alone(store, plan, tile))
            << int(tile.zoom) << '/' << tile.x << '/' << tile.y;
    }
    ASSERT_FALSE(tiles_512.empty());
    for (const auto& [tile, png] : tiles_512) {
        EXPECT_TRUE(png == alone(store, plan_512, tile))
            << int(tile.zoom) << '/' << tile.x << '/' << tile.y;
    }
}

TEST(PictureTiles, AreTheSameWhateverTheNumberOfJobs) {
    const auto file = town_store();
    auto plan = plan_of(file, 10, 16);
    const auto once = drawn(file, plan);
    plan.jobs = 3;
    EXPECT_EQ(drawn(file, plan), once);
}

TEST(PictureTiles, CoverTheirBoxAtEveryZoom) {
    const auto file = town_store();
    const auto plan = plan_of(file, 14, 16);
    const auto tiles = drawn(file, plan);
    std::size_t expected = 0;
    for (int zoom = 14; zoom <= 16; ++zoom) {
        const auto range = tiles_of(plan.box, zoom);
        expected +=
            std::size_t{range.last_x - range.first_x + 1} * (range.last_y - range.first_y + 1);
    }
    EXPECT_EQ(tiles.size(), expected);
}

TEST(PictureTiles, SayWhatStoppedAProcessThatDraws) {
    const auto file = town_store();
    const auto plan = plan_of(file, 14, 15);
    fs::remove(file);
    EXPECT_THAT([&] { drawn(file, plan); },
                ::testing::ThrowsMessage<InputError>(::testing::HasSubstr(file.string())));
}

TEST(PictureTiles, StopWhenTheyAreNoLongerWanted) {
    const auto file = town_store();
    std::stop_source stop;
    stop.request_stop();
    PicturePainters painters{file, plan_of(file, 6, 17)};
    const Progress progress{.report = {}, .stop = stop.get_token()};
    EXPECT_EQ(
        refusal_of([&] { painters.collect([](const TileId&, std::string_view) {}, progress); }),
        "stopped before the file was complete");
}

/// Processes that this one has started and not yet waited for.
std::vector<pid_t> children() {
    std::ifstream in{"/proc/self/task/" + std::to_string(getpid()) + "/children"};
    return {std::istream_iterator<pid_t>{in}, {}};
}

std::string failure_after(int signal) {
    const auto file = town_store();
    PicturePainters painters{file, plan_of(file, 6, 17)};
    const auto processes = children();
    EXPECT_EQ(processes.size(), 1U);
    for (const auto process : processes) {
        ::kill(process, signal);
    }
    try {
        painters.collect([](const TileId&, std::string_view) {}, {});
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(PictureTiles, EndWithWordsWhenADrawingProcessIsKilled) {
    EXPECT_EQ(failure_after(SIGKILL), "a drawing process was ended by signal 9 (Killed)");
    EXPECT_TRUE(children().empty());
}

TEST(PictureTiles, EndWithWordsWhenADrawingProcessStandsStill) {
    EXPECT_THAT(failure_after(SIGSTOP), ::testing::HasSubstr("has made no progress for 8 s"));
    EXPECT_TRUE(children().empty());
}

TEST(PictureTiles, AreNotBegunBesideAThread) {
    const auto file = town_store();
    const auto plan = plan_of(file, 14, 15);
    const std::jthread another{[](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
            std::this_thread::sleep_for(std::chrono::milliseconds{10});
        }
    }};
    EXPECT_THAT([&] { PicturePainters(file, plan); },
                ::testing::ThrowsMessage<std::logic_error>(
                    "drawing processes must be started before any thread"));
}

TEST(PictureTiles, GoIntoAnArchiveWhereTheSameBytesAreKeptOnce) {
    const auto file = town_store();
    const auto archive = file.parent_path() / "town.mbtiles";
    run(*command_named("export"),
        {file.string(),
         "-o",
         archive.string(),
         "--tiles",
         "picture",
         "--zoom",
         "6-15",
         "--bbox",
         "17.99,59.29,18.05,59.33",
         "--jobs",
         "2"});
    Database database{archive, Database::Access::read};
    auto format = database.prepare("SELECT value FROM metadata WHERE name = 'format'");
    ASSERT_TRUE(format.step());
    EXPECT_EQ(format.text(0), "png");
    auto counts = database.prepare("SELECT COUNT(*), (SELECT COUNT(*) FROM images) FROM map");
    ASSERT_TRUE(counts.step());
    EXPECT_LT(counts.integer(1), counts.integer(0)); // most of the box is empty
}

TEST(PictureTiles, AreTheSameInAFolder) {
    const auto file = town_store();
    const auto place = file.parent_path() / "tiles/";
    run(*command_named("export"),
        {file.string(), "-o", place.string(), "--tiles", "picture", "--zoom", "13-15"});
    std::size_t files = 0;
    for (const auto& entry : fs::recursive_directory_iterator{place}) {
        files += entry.is_regular_file() ? 1 : 0;
    }
    const auto tiles = drawn(file, plan_of(file, 13, 15));
    EXPECT_EQ(files, tiles.size() + 1); // and metadata.json
    for (const auto& [tile, bytes] : tiles) {
        std::ifstream in{place / std::to_string(tile.zoom) / std::to_string(tile.x) /
                             (std::to_string(tile.y) + ".png"),
                         std::ios::binary};
        EXPECT_TRUE((std::string{std::istreambuf_iterator<char>{in}, {}} == bytes));
    }
}

TEST(PictureTiles, RefuseOptionsThatDoNotFit) {
    EXPECT_EQ(misuse_of({"a.gpkg", "-o", "a.csv", "--tiles", "picture"}),
              "--tiles is for tile output, expected -o to end in .mbtiles, .pmtiles or /");
    EXPECT_EQ(
        misuse_of({"a.gpkg", "-o", "a.mbtiles", "--theme", "dark"}),
        "--tile-size, --theme, --style, --grey-below, --left-hand and --no-labels require --tiles "
        "picture");
    EXPECT_EQ(misuse_of({"a.gpkg", "-o", "a.mbtiles", "--tiles", "picture", "--road", "Ring"}),
              "--tiles picture shows all roads of a box: combine it with --bbox and "
              "--grey-below only, not with options that select segments");
}

} // namespace macadam::testing
