// What a picture costs: the product's map beside the same lines drawn by Cairo, with towns of
// doubling size.

#include "render/map/map_plan.hpp"
#include "support/roads/town.hpp"

#include <benchmark/benchmark.h>

#include <cairo.h>

#include <cmath>
#include <numbers>

namespace macadam {
namespace {

constexpr int size_px = 2048;

/// Every street of a town in pieces of one class each, as segments come from a store.
MapScene town_scene(int side) {
    const auto roads = testing::made_up_town(side);
    MapScene scene;
    scene.box = extent_of(roads);
    int number = 0;
    for (std::uint32_t i = 0; i < link_count(roads); ++i) {
        for (const bool forward : {true, false}) {
            const auto edge = edge_of(LinkId{i}, forward);
            if (is_drivable(roads, edge)) {
                scene.lines.push_back({.line = line_of(roads, edge),
                                       .iri_class = number++ % 3,
                                       .both_ways = is_drivable(roads, reversed(edge)),
                                       .forward = forward,
                                       .rank = 3,
                                       .certain = true,
                                       .name = {}});
            }
        }
    }
    return scene;
}

void draw_in_macadam(benchmark::State& state) {
    const auto scene = town_scene(static_cast<int>(state.range(0)));
    for (auto _ : state) {
        benchmark::DoNotOptimize(render_map(scene, {.legend = false}, {size_px, size_px}));
    }
    state.counters["lines"] = static_cast<double>(scene.lines.size());
}

/// Casing and core, round joins, antialiased: what a general library makes of the same lines.
void draw_in_cairo(benchmark::State& state) {
    const auto scene = town_scene(static_cast<int>(state.range(0)));
    const auto colours = ramp_colours("rdylbu", 3);
    const double scale_x = size_px / (scene.box.east_deg - scene.box.west_deg);
    const double scale_y = size_px / (scene.box.north_deg - scene.box.south_deg);
    for (auto _ : state) {
        auto* const surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, size_px, size_px);
        auto* const cairo = cairo_create(surface);
        cairo_set_source_rgb(cairo, 0.95, 0.95, 0.95);
        cairo_paint(cairo);
        cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
        cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
        for (const bool casing : {true, false}) {
            cairo_set_line_width(cairo, casing ? 4.5 : 3);
            for (const auto& line : scene.lines) {
                const auto colour =
                    casing ? 0x303030U : colours[static_cast<std::size_t>(line.iri_class)];
                cairo_set_source_rgb(cairo,
                                     (colour >> 16U & 0xFFU) / 255.0,
                                     (colour >> 8U & 0xFFU) / 255.0,
                                     (colour & 0xFFU) / 255.0);
                for (const auto& point : line.line) {
                    cairo_line_to(cairo,
                                  (point.lon_deg - scene.box.west_deg) * scale_x,
                                  (scene.box.north_deg - point.lat_deg) * scale_y);
                }
                cairo_stroke(cairo);
            }
        }
        cairo_surface_flush(surface);
        benchmark::DoNotOptimize(cairo_image_surface_get_data(surface));
        cairo_destroy(cairo);
        cairo_surface_destroy(surface);
    }
    state.counters["lines"] = static_cast<double>(scene.lines.size());
}

void encode_picture(benchmark::State& state) {
    const auto image = render_map(town_scene(50), {.legend = false}, {size_px, size_px});
    for (auto _ : state) {
        benchmark::DoNotOptimize(encode_png(image));
    }
}

BENCHMARK(draw_in_macadam)->Arg(25)->Arg(50)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond);
BENCHMARK(draw_in_cairo)->Arg(25)->Arg(50)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond);
BENCHMARK(encode_picture)->Unit(benchmark::kMillisecond);

} // namespace
} // namespace macadam
