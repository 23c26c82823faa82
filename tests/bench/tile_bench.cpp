// Tiles out of a large store: pictures beside Mapnik with its OGR plugin and beside Cairo, on the
// same tiles of the same GeoPackage in one run; and vector tiles. Prints rows of tables.
//
//     tile_bench make STORE.gpkg SIDE     a town of SIDE x SIDE crossings; 223 are a million
//     segments tile_bench pictures STORE.gpkg tile_bench vectors STORE.gpkg tile_bench map
//     STORE.gpkg           one large picture

#include "app/export/tile_line_merging.hpp"
#include "app/render/map_scene.hpp"
#include "clock.hpp"
#include "driven_town.hpp"
#include "estimator/common/error.hpp"
#include "render/roads/line_widths.hpp"
#include "render/tiles/mvt_tile.hpp"
#include "render/tiles/tile_painter.hpp"
#include "render/tiles/tile_png.hpp"
#include "storage/files/gzip.hpp"
#include "support/roads/town.hpp"
#include "tile_bench_peers.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using bench::cost_ms;
using bench::median;

constexpr GeoPoint corner{51, 13}; // where a tile of zoom 15 holds about 1,000 segments
constexpr std::size_t tiles_measured = 64;
constexpr int rounds = 3;

void make_store(const fs::path& file, int side) {
    const auto roads = testing::made_up_town(side, corner);
    auto store =
        RoadStore::create(file, roads, {.network_source = "town", .attribution = "made up"});
    // Five alike, of any class.
    const auto um_of = [](std::int64_t number) { return 800 + number / 5 * 7919 % 2700; };
    bench::add_trip(store, bench::trip_number(0), bench::passes_over(bench::keys_of(roads), um_of));
    store.importer.refresh();
}

/// Tiles all over the town, none at its edge.
std::vector<TileId> tiles_in(const GeoBox& town, int zoom) {
    const auto range = tiles_of(town, zoom);
    std::vector<TileId> tiles;
    for (std::size_t i = 0; i < tiles_measured; ++i) {
        const auto at = [&](std::uint32_t first, std::uint32_t last, std::size_t step) {
            const auto inside = last - first - 1;
            return first + 1 + static_cast<std::uint32_t>(step % inside);
        };
        tiles.push_back({static_cast<std::uint8_t>(zoom),
                         at(range.first_x, range.last_x, i * 7),
                         at(range.first_y, range.last_y, i * 5 + i / 8)});
    }
    return tiles;
}

struct Setting {
    int tile_px;
    int zoom;
};

/// From the store to a PNG.
class OurTiles {
public:
    OurTiles(const fs::path& file, const Setting& setting)
        : store_{StoreReader::open(file)}, painter_{{{}, setting.tile_px, 1}}, png_{MapStyle{}},
          setting_{setting}, rules_{tile_line_rules({setting.zoom, setting.tile_px},
                                                    store_.settings().segment_length_m,
                                                    painter_.reach_px(setting.zoom))} {}

    std::vector<MapLine> lines(const TileId& tile) const {
        return tile_lines(store_, tile_box(tile), rules_, *class_table("fhwa"));
    }
    Image draw(const TileId& tile, const std::vector<MapLine>& lines) {
        return painter_.draw(tile, lines);
    }
    std::vector<std::uint8_t> encode(const Image& image) {
        return png_.encode(image, {0, 0, setting_.tile_px});
    }
    std::size_t segments(const TileId& tile) const {
        SegmentFilter filter;
        filter.box = tile_box(tile);
        std::size_t count = 0;
        store_.visit(filter, [&](const SegmentRecord&) { ++count; });
        return count;
    }
    double casing_px() const { return tile_widths_of().casing_px; }
    double core_px() const { return tile_widths_of().core_px; }

private:
    LineWidths tile_widths_of() const {
        return tile_widths(zoom_of_256_px({setting_.zoom, setting_.tile_px}));
    }
    StoreReader store_;
    TilePainter painter_;
    TilePng png_;
    Setting setting_;
    TileLineRules rules_;
};

void measure_tiles(const fs::path& file, const Setting& setting) {
    OurTiles ours{file, setting};
    bench::MapnikTiles theirs{
        file.string(), "roughness", setting.tile_px, ours.core_px(), ours.casing_px()};
    const auto town = StoreReader::open(file).info().box;
    const auto tiles = tiles_in(town, setting.zoom);
    std::size_t segments = 0;
    for (const auto& tile : tiles) {
        segments += ours.segments(tile);
    }
    std::vector<double> query_ms, draw_ms, encode_ms, all_ms, mapnik_ms, mapnik_png_ms, cairo_ms;
    std::size_t our_bytes = 0;
    std::size_t their_bytes = 0;
    for (int round = 0; round < rounds; ++round) {
        for (const auto& tile : tiles) {
            std::vector<MapLine> lines;
            Image image;
            query_ms.push_back(cost_ms([&] { lines = ours.lines(tile); }));
            draw_ms.push_back(cost_ms([&] { image = ours.draw(tile, lines); }));
            encode_ms.push_back(cost_ms([&] { our_bytes += ours.encode(image).size(); }));
            all_ms.push_back(query_ms.back() + draw_ms.back() + encode_ms.back());
            mapnik_ms.push_back(cost_ms([&] { theirs.draw(tile_box(tile)); }));
            mapnik_png_ms.push_back(cost_ms([&] { their_bytes += theirs.png8().size(); }));
            cairo_ms.push_back(cost_ms([&] {
                bench::draw_in_cairo(
                    lines, tile_box(tile), setting.tile_px, ours.core_px(), ours.casing_px());
            }));
        }
    }
    const double our_ms = median(all_ms);
    const double their_ms = median(mapnik_ms) + median(mapnik_png_ms);
    fmt::print(
        "| {} px, zoom {}, {} segments | {:.2f} | {:.2f} | {:.2f} | {:.2f} ({:.0f}/s, {:.1f} "
        "kB) | {:.2f} | {:.2f} | {:.2f} ({:.0f}/s, {:.1f} kB) | {:.1f} | {:.2f} | {:.1f} |\n",
        setting.tile_px,
        setting.zoom,
        segments / tiles.size(),
        median(query_ms),
        median(draw_ms),
        median(encode_ms),
        our_ms,
        1e3 / our_ms,
        double(our_bytes) / double(all_ms.size()) / 1e3,
        median(mapnik_ms),
        median(mapnik_png_ms),
        their_ms,
        1e3 / their_ms,
        double(their_bytes) / double(all_ms.size()) / 1e3,
        their_ms / our_ms,
        median(cairo_ms),
        median(cairo_ms) / median(draw_ms));
    std::fflush(stdout);
}

/// From the store to gzip, one tile after the other.
void measure_vector_tiles(const StoreReader& store, const StoreInfo& info, int zoom) {
    const auto tiles = tiles_in(info.box, zoom);
    constexpr double margin = double{tile_buffer} / tile_extent;
    std::vector<double> query_ms, encode_ms, gzip_ms;
    std::size_t count = 0, gzip_bytes = 0;
    for (int round = 0; round < rounds; ++round) {
        for (const auto& tile : tiles) {
            TileWords words;
            std::vector<TileSegment> segments;
            std::string bytes;
            query_ms.push_back(cost_ms([&] {
                SegmentFilter filter;
                filter.box = tile_box(tile, margin);
                store.visit(
                    filter,
                    [&](const SegmentRecord& record) {
                        segments.push_back(tile_segment(record, words));
                    },
                    StateDetail::tiles);
            }));
            encode_ms.push_back(cost_ms([&] {
                std::vector<const TileSegment*> pointers;
                for (const auto& segment : segments) {
                    pointers.push_back(&segment);
                }
                bytes =
                    vector_tile(tile, pointers, SegmentDetail::full, {&words, class_table("fhwa")});
            }));
            gzip_ms.push_back(cost_ms([&] { gzip_bytes += gzipped(bytes).size(); }));
            count += segments.size();
        }
    }
    const auto made = double(query_ms.size());
    const double all_ms = median(query_ms) + median(encode_ms) + median(gzip_ms);
    fmt::print("| zoom {}, {:.0f} segments, of {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} ({:.0f}/s, "
               "{:.1f} kB) |\n",
               zoom,
               double(count) / made,
               info.segments,
               median(query_ms),
               median(encode_ms),
               median(gzip_ms),
               all_ms,
               1e3 / all_ms,
               double(gzip_bytes) / made / 1e3);
}

/// A map of 4096 x 4096 px, from the store to the PNG.
void measure_map(const fs::path& file) {
    const auto store = StoreReader::open(file);
    const auto town = store.info().box;
    // A third of the town's sides has about a ninth of its segments.
    const GeoBox box{std::lerp(town.west_deg, town.east_deg, 0.33),
                     std::lerp(town.south_deg, town.north_deg, 0.33),
                     std::lerp(town.west_deg, town.east_deg, 0.65),
                     std::lerp(town.south_deg, town.north_deg, 0.65)};
    MapScene scene;
    Image image;
    MapRequest request{.title = "Town", .size = {.width_px = 4096, .height_px = 4096}};
    request.filter.box = box;
    request.style.classes = class_table("fhwa");
    const double query_ms = cost_ms([&] { scene = load_map(store, request).scene(); });
    const double draw_ms = cost_ms([&] { image = render_map(scene, {}, {4096, 4096}); });
    const double encode_ms = cost_ms([&] { encode_png(image); });
    fmt::print("A map of 4096 x 4096 px with {} segments: {:.2f} s to draw and {:.2f} s for the "
               "PNG (CPU); reading them from the store {:.2f} s.\n",
               scene.lines.size(),
               draw_ms / 1e3,
               encode_ms / 1e3,
               query_ms / 1e3);
}

void measure_pictures(const fs::path& file) {
    for (const auto& setting : {Setting{256, 16}, {256, 15}, {512, 15}, {256, 14}, {512, 14}}) {
        measure_tiles(file, setting);
    }
}

void run(std::string_view what, const fs::path& file, int side) {
    if (what == "make") {
        make_store(file, side);
    } else if (what == "pictures") {
        measure_pictures(file);
    } else if (what == "vectors") {
        const auto store = StoreReader::open(file);
        const auto info = store.info();
        for (const int zoom : {16, 15, 14}) {
            measure_vector_tiles(store, info, zoom);
        }
    } else if (what == "map") {
        measure_map(file);
    } else {
        throw InputError{fmt::format("'{}', expected make, pictures, vectors or map", what)};
    }
}

} // namespace
} // namespace macadam

int main(int argc, char** argv) {
    try {
        if (argc < 3) {
            throw macadam::InputError{"expected what to do and a store"};
        }
        macadam::run(argv[1], argv[2], argc > 3 ? std::atoi(argv[3]) : 223);
    } catch (const std::exception& error) {
        fmt::print(stderr, "tile_bench: {}\n", error.what());
        return 1;
    }
    return 0;
}
