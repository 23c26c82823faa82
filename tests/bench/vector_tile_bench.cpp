// What vector tiles cost: one tile of about a thousand segments asked of a store by its place, the
// same from memory, and all tiles of zooms 14 and 15 of a town beside GDAL's driver for them, from
// its export of the same segments.

#include "app/tiles/tile_pyramid.hpp"
#include "driven_town.hpp"
#include "render/tiles/mvt_tile.hpp"
#include "storage/exports/export.hpp"
#include "storage/files/gzip.hpp"
#include "storage/store/road_store.hpp"
#include "storage/tiles/tile_archive.hpp"
#include "support/roads/town.hpp"

#include <benchmark/benchmark.h>
#include <gdal_utils.h>
#include <ogr_api.h>

#include <filesystem>
#include <string>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr int side = 60;      // crossings along the town: about 70,000 segments
constexpr int tile_zoom = 15; // whose tiles hold about a thousand of them

const bench::ScratchFolder& scratch() {
    static const bench::ScratchFolder folder{"macadam_tiles"};
    return folder;
}

/// One pass over every segment, fused.
RoadStore new_driven_town() {
    const auto roads = testing::made_up_town(side);
    auto store = RoadStore::create(scratch() / "town.gpkg", roads, {});
    const auto um_of = [](std::int64_t number) { return 1000 + (number * 7919) % 4000; };
    bench::add_trip(store, bench::trip_number(0), bench::passes_over(bench::keys_of(roads), um_of));
    store.importer.refresh();
    return store;
}

const StoreReader& driven_town() {
    static const auto store = new_driven_town();
    return store;
}

const ClassTable& classes() {
    return *class_table("fhwa");
}

/// In the middle of the town.
TileId middle_tile() {
    const auto box = driven_town().info().box;
    const auto place = tile_position(
        {(box.south_deg + box.north_deg) / 2, (box.west_deg + box.east_deg) / 2}, tile_zoom);
    return {tile_zoom, std::uint32_t(place.x), std::uint32_t(place.y)};
}

struct Content {
    TileWords words;
    std::vector<TileSegment> segments;
};

Content content_of(const TileId& tile) {
    constexpr double margin = double{tile_buffer} / tile_extent;
    Content content;
    SegmentFilter filter;
    filter.box = tile_box(tile, margin);
    driven_town().visit(
        filter,
        [&](const SegmentRecord& record) {
            content.segments.push_back(tile_segment(record, content.words));
        },
        StateDetail::tiles);
    return content;
}

std::string packed(const TileId& tile, const Content& content) {
    std::vector<const TileSegment*> segments;
    for (const auto& segment : content.segments) {
        segments.push_back(&segment);
    }
    return gzipped(vector_tile(tile, segments, SegmentDetail::full, {&content.words, &classes()}));
}

void count(benchmark::State& state, std::size_t segments) {
    state.counters["segments"] = static_cast<double>(segments);
    state.counters["segments/s"] = benchmark::Counter(
        static_cast<double>(segments), benchmark::Counter::kIsIterationInvariantRate);
}

void make_tile_from_store(benchmark::State& state) {
    const auto tile = middle_tile();
    std::size_t segments = 0;
    for (auto _ : state) {
        const auto content = content_of(tile);
        segments = content.segments.size();
        benchmark::DoNotOptimize(packed(tile, content));
    }
    count(state, segments);
}
BENCHMARK(make_tile_from_store)->Unit(benchmark::kMillisecond);

void make_tile_from_memory(benchmark::State& state) {
    const auto tile = middle_tile();
    const auto content = content_of(tile);
    for (auto _ : state) {
        benchmark::DoNotOptimize(packed(tile, content));
    }
    count(state, content.segments.size());
}
BENCHMARK(make_tile_from_memory)->Unit(benchmark::kMillisecond);

void export_tiles_in_macadam(benchmark::State& state) {
    const auto file = scratch() / "ours.mbtiles";
    const TilePlan plan{.min_zoom = static_cast<int>(state.range(0)),
                        .max_zoom = static_cast<int>(state.range(0))};
    std::size_t segments = 0;
    driven_town();
    for (auto _ : state) {
        TileSource source{file};
        read_tile_source(driven_town(), {}, source, {});
        TileArchive archive{file,
                            {.name = "town",
                             .description = "",
                             .attribution = "",
                             .format = TileSetNote::Format::mvt,
                             .bounds = source.box,
                             .min_zoom = plan.min_zoom,
                             .max_zoom = plan.max_zoom,
                             .layers = {}}};
        make_vector_tiles(
            source,
            classes(),
            plan,
            [&](const TileId& tile, std::string_view bytes) { archive.add(tile, bytes); },
            {});
        archive.commit();
        segments = source.count;
    }
    count(state, segments);
}
BENCHMARK(export_tiles_in_macadam)
    ->Arg(14)
    ->Arg(15)
    ->Iterations(3)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

void export_tiles_in_gdal(benchmark::State& state) {
    const auto from = scratch() / "export.gpkg", to = scratch() / "gdal.mbtiles";
    const auto segments = export_segments(driven_town(), {}, from);
    const auto least = "MINZOOM=" + std::to_string(state.range(0)),
               most = "MAXZOOM=" + std::to_string(state.range(0));
    const char* words[] = {"-f", "MBTILES", "-dsco", least.c_str(), "-dsco", most.c_str(), nullptr};
    GDALAllRegister();
    for (auto _ : state) {
        fs::remove(to);
        auto* source = GDALOpenEx(from.c_str(), GDAL_OF_VECTOR, nullptr, nullptr, nullptr);
        auto* options =
            GDALVectorTranslateOptionsNew(const_cast<char**>(words), nullptr); // NOLINT: C API
        int failed = 0;
        GDALClose(GDALVectorTranslate(to.c_str(), nullptr, 1, &source, options, &failed));
        GDALVectorTranslateOptionsFree(options);
        GDALClose(source);
        if (failed != 0) {
            state.SkipWithError("GDAL made no tiles");
            return;
        }
    }
    count(state, segments);
}
BENCHMARK(export_tiles_in_gdal)
    ->Arg(14)
    ->Arg(15)
    ->Iterations(3)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

} // namespace
} // namespace macadam
