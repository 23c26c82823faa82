// Picture tiles out of a large store, beside Mapnik with its OGR plugin and beside Cairo, on the
// same tiles of the same GeoPackage in one run. Prints tables.
//
//     tile_bench [STORE.gpkg]     made, and taken away again, if none is named

#include "app/map_scene.hpp"
#include "app/tile_lines.hpp"
#include "estimator/common/error.hpp"
#include "render/line_widths.hpp"
#include "render/tile_painter.hpp"
#include "render/tile_png.hpp"
#include "support/town.hpp"
#include "tile_bench_peers.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <numeric>

#include <sys/wait.h>
#include <unistd.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr int town_side = 223; // crossings: a million segments
constexpr std::size_t tiles_measured = 64;
constexpr int rounds = 3;

double cpu_s() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double wall_s() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

template <typename Work>
double cost_ms(const Work& work) {
    const double begin_s = cpu_s();
    work();
    return (cpu_s() - begin_s) * 1e3;
}

void make_store(const fs::path& file) {
    const auto roads = testing::made_up_town(town_side);
    auto store =
        RoadStore::create(file, roads, {.network_source = "town", .attribution = "made up"});
    std::vector<SegmentKey> keys;
    for (std::uint32_t i = 0; i < link_count(roads); ++i) {
        for (const bool forward : {true, false}) {
            if (const auto edge = edge_of(LinkId{i}, forward); is_drivable(roads, edge)) {
                for (const auto& segment : segments_of(roads, edge)) {
                    keys.push_back(segment.key);
                }
            }
        }
    }
    std::vector<Pass> passes;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const auto um = static_cast<IriUm>(800 + i / 5 * 7919 % 2700); // five alike, of any class
        passes.push_back({.segment = keys[i],
                          .occurrence = 0,
                          .iri_left_um = {},
                          .iri_right_um = {},
                          .iri_centre_um = um,
                          .iri_um = um,
                          .sd_um = um / 5,
                          .centre_only = true,
                          .validity = 0,
                          .speed_mmps = 14000,
                          .covered_mm = 20000,
                          .confidence_ppm = 990000,
                          .t_ms = 0});
    }
    TripRecord trip;
    trip.trip_id = "everywhere";
    trip.sha256 = std::string(64, '0');
    trip.vehicle_id = "car";
    trip.t0_utc_ms = 1'767'225'600'000;
    store.add_trip(trip, passes);
    store.refresh();
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
        : store_{RoadStore::open(file, RoadStore::Access::read)},
          painter_{{{}, setting.tile_px, 1}}, png_{MapStyle{}}, setting_{setting},
          rules_{tile_line_rules({setting.zoom, setting.tile_px},
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
    RoadStore store_;
    TilePainter painter_;
    TilePng png_;
    Setting setting_;
    TileLineRules rules_;
};

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

void measure_tiles(const fs::path& file, const Setting& setting) {
    OurTiles ours{file, setting};
    bench::MapnikTiles theirs{
        file.string(), "roughness", setting.tile_px, ours.core_px(), ours.casing_px()};
    const auto town = RoadStore::open(file, RoadStore::Access::read).info().box;
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
        "kB) | {:.2f} | {:.2f} | {:.2f} ({:.0f}/s, {:.1f} kB) | {:.1f} | {:.2f} |\n",
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
        median(cairo_ms));
    std::fflush(stdout);
}

/// Wall seconds of `processes` that share the tiles; each opens the store and a context of its own.
double shared_s(const fs::path& file, int processes) {
    constexpr Setting setting{256, 15};
    const auto town = RoadStore::open(file, RoadStore::Access::read).info().box;
    const auto tiles = tiles_in(town, setting.zoom);
    const double begin_s = wall_s();
    for (int process = 0; process < processes; ++process) {
        if (fork() == 0) {
            OurTiles ours{file, setting};
            for (int repeat = 0; repeat < 16; ++repeat) {
                for (auto i = static_cast<std::size_t>(process); i < tiles.size();
                     i += static_cast<std::size_t>(processes)) {
                    ours.encode(ours.draw(tiles[i], ours.lines(tiles[i])));
                }
            }
            _exit(0);
        }
    }
    for (int process = 0; process < processes; ++process) {
        wait(nullptr);
    }
    return wall_s() - begin_s;
}

/// A map of 4096 x 4096 px, from the store to the PNG.
void measure_map(const fs::path& file) {
    const auto store = RoadStore::open(file, RoadStore::Access::read);
    const auto town = store.info().box;
    // A third of the town's sides has about a ninth of its segments.
    const GeoBox box{std::lerp(town.west_deg, town.east_deg, 0.33),
                     std::lerp(town.south_deg, town.north_deg, 0.33),
                     std::lerp(town.west_deg, town.east_deg, 0.65),
                     std::lerp(town.south_deg, town.north_deg, 0.65)};
    MapScene scene;
    Image image;
    MapRequest request{.box = box, .title = "Town", .width_px = 4096, .height_px = 4096};
    request.style.classes = class_table("fhwa");
    const double query_ms = cost_ms([&] { scene = map_scene(store, request); });
    const double draw_ms = cost_ms([&] { image = render_map(scene, {}, 4096, 4096); });
    const double encode_ms = cost_ms([&] { encode_png(image); });
    fmt::print("\nA map of 4096 x 4096 px with {} segments: {:.2f} s to draw and {:.2f} s for the "
               "PNG (CPU); reading them from the store {:.2f} s.\n",
               scene.lines.size(),
               draw_ms / 1e3,
               encode_ms / 1e3,
               query_ms / 1e3);
}

void measure(const fs::path& file) {
    // Before any context: processes share none.
    const double one_s = shared_s(file, 1);
    const double two_s = shared_s(file, 2);
    fmt::print("| tile | query | draw | PNG | all, ms of CPU | Mapnik + OGR | its png8 | both | "
               "times ours | Cairo, draw alone |\n|---|---|---|---|---|---|---|---|---|---|\n");
    for (const auto& setting : {Setting{256, 15}, {512, 15}, {256, 14}, {512, 14}, {256, 16}}) {
        measure_tiles(file, setting);
    }
    fmt::print("\nTwo processes: {:.2f} times as fast as one.\n", one_s / two_s);
    measure_map(file);
}

} // namespace
} // namespace macadam

int main(int argc, char** argv) {
    namespace fs = std::filesystem;
    const bool made = argc < 2;
    const auto file =
        made ? fs::temp_directory_path() / fmt::format("macadam_tile_bench_{}.gpkg", getpid())
             : fs::path{argv[1]};
    int status = 0;
    try {
        if (made) {
            macadam::make_store(file);
        }
        macadam::measure(file);
    } catch (const std::exception& error) {
        fmt::print(stderr, "tile_bench: {}\n", error.what());
        status = 1;
    }
    if (made) {
        std::error_code ignored;
        fs::remove(file, ignored);
    }
    return status;
}
