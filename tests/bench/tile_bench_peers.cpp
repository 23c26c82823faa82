#include "tile_bench_peers.hpp"

#include <mapnik/agg_renderer.hpp>
#include <mapnik/datasource_cache.hpp>
#include <mapnik/image_util.hpp>
#include <mapnik/layer.hpp>
#include <mapnik/load_map.hpp>
#include <mapnik/map.hpp>

#include <cairo.h>
#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace macadam::bench {
namespace {

constexpr double rad_per_deg = std::numbers::pi / 180;
constexpr double sphere_m = 6378137.0;

double mercator_y_m(double lat_deg) {
    return sphere_m * std::asinh(std::tan(lat_deg * rad_per_deg));
}

std::string line_rule(const char* condition, const char* colour, double width_px) {
    return fmt::format(
        "<Rule>{}<LineSymbolizer stroke='{}' stroke-width='{}' stroke-linejoin='round' "
        "stroke-linecap='round'/></Rule>",
        condition,
        colour,
        width_px);
}

std::string
map_xml(const std::string& file, const std::string& layer, double core_px, double casing_px) {
    const auto is = [](const char* name) {
        return fmt::format("<Filter>[class] = '{}'</Filter>", name);
    };
    return fmt::format(
        "<Map srs='+proj=merc +a=6378137 +b=6378137 +lon_0=0 +x_0=0 +y_0=0 +units=m +no_defs' "
        "background-color='#f4f4f2'>"
        "<Style name='casing'>{}</Style><Style name='core'>{}{}{}</Style>"
        "<Layer name='roads' srs='+proj=longlat +datum=WGS84 +no_defs'>"
        "<StyleName>casing</StyleName><StyleName>core</StyleName>"
        "<Datasource><Parameter name='type'>ogr</Parameter><Parameter name='file'>{}</Parameter>"
        "<Parameter name='layer'>{}</Parameter></Datasource></Layer></Map>",
        line_rule("", "#303030", core_px + 2 * casing_px),
        line_rule(is("good").c_str(), "#2c7bb6", core_px),
        line_rule(is("fair").c_str(), "#ffdf9a", core_px),
        line_rule(is("poor").c_str(), "#d7191c", core_px),
        file,
        layer);
}

} // namespace

struct MapnikTiles::Impl {
    mapnik::Map map;
    mapnik::image_rgba8 image;
};

MapnikTiles::MapnikTiles(const std::string& file,
                         const std::string& layer,
                         int tile_px,
                         double core_px,
                         double casing_px)
    : impl_{new Impl{mapnik::Map{tile_px, tile_px}, mapnik::image_rgba8{tile_px, tile_px}}} {
    mapnik::datasource_cache::instance().register_datasources("/usr/lib/mapnik/3.1/input");
    mapnik::load_map_string(impl_->map, map_xml(file, layer, core_px, casing_px));
}

MapnikTiles::~MapnikTiles() = default;

void MapnikTiles::draw(const GeoBox& box) {
    impl_->map.zoom_to_box({sphere_m * box.west_deg * rad_per_deg,
                            mercator_y_m(box.south_deg),
                            sphere_m * box.east_deg * rad_per_deg,
                            mercator_y_m(box.north_deg)});
    mapnik::agg_renderer<mapnik::image_rgba8> renderer{impl_->map, impl_->image};
    renderer.apply();
}

std::string MapnikTiles::png8() const {
    return mapnik::save_to_string(impl_->image, "png8:z=1");
}

void draw_in_cairo(const std::vector<MapLine>& lines,
                   const GeoBox& box,
                   int side_px,
                   double core_px,
                   double casing_px) {
    const auto colours = ramp_colours("rdylbu", 3);
    const double left = box.west_deg;
    const double top = mercator_y_m(box.north_deg);
    const double scale_x = side_px / (box.east_deg - box.west_deg);
    const double scale_y = side_px / (top - mercator_y_m(box.south_deg));
    auto* const surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, side_px, side_px);
    auto* const cairo = cairo_create(surface);
    cairo_set_source_rgb(cairo, 0.95, 0.95, 0.95);
    cairo_paint(cairo);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
    for (const bool casing : {true, false}) {
        cairo_set_line_width(cairo, core_px + (casing ? 2 * casing_px : 0));
        for (const auto& line : lines) {
            const auto colour = casing || line.iri_class < 0
                                    ? 0x303030U
                                    : colours[static_cast<std::size_t>(line.iri_class)];
            cairo_set_source_rgb(cairo,
                                 (colour >> 16U & 0xFFU) / 255.0,
                                 (colour >> 8U & 0xFFU) / 255.0,
                                 (colour & 0xFFU) / 255.0);
            for (const auto& point : line.line) {
                cairo_line_to(cairo,
                              (point.lon_deg - left) * scale_x,
                              (top - mercator_y_m(point.lat_deg)) * scale_y);
            }
            cairo_stroke(cairo);
        }
    }
    cairo_surface_flush(surface);
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
}

} // namespace macadam::bench
