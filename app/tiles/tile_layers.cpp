#include "app/tiles/tile_layers.hpp"

#include "mapping/style/iri_class.hpp"
#include "render/tiles/mvt_background.hpp"
#include "render/tiles/mvt_tile.hpp"
#include "storage/store/reader/store_background.hpp"

#include <algorithm>
#include <string>

namespace macadam {
namespace {

TileLayer layer_of(const TilePlan& plan, const ClassTable& classes) {
    TileLayer layer{.id = std::string{roughness_layer},
                    .description = plan.units == TileUnits::us
                                       ? "About 66 ft of road in one direction from zoom 14 on, "
                                         "longer intervals below it; IRI in in/mi"
                                       : "About 20 m of road in one direction from zoom 14 on, "
                                         "longer intervals below it; IRI in mm/m",
                    .min_zoom = plan.min_zoom,
                    .max_zoom = plan.max_zoom,
                    .fields = {}};
    for (const auto& field : vector_fields(classes, plan.units)) {
        layer.fields.push_back({field.name, field.is_number ? "Number" : "String"});
    }
    return layer;
}

TileLayer layer_of(const TilePlan& plan, const BackgroundLayer& background) {
    TileLayer layer{.id = std::string{background.name},
                    .description = "Background",
                    .min_zoom = std::max(plan.min_zoom, background.min_zoom),
                    .max_zoom = plan.max_zoom,
                    .fields = {}};
    layer.fields.push_back({"kind", "String"});
    if (background.name == background_layers().back().name) { // places
        layer.fields.push_back({"name", "String"});
        layer.fields.push_back({"rank", "Number"});
    }
    return layer;
}

} // namespace

std::vector<TileLayer> tile_layers(const StoreReader& store, const TilePlan& plan) {
    std::vector<TileLayer> layers;
    if (!StoreBackground{store}.size().is_empty()) {
        for (const auto& each : background_layers()) {
            if (each.min_zoom <= plan.max_zoom) {
                layers.push_back(layer_of(plan, each));
            }
        }
    }
    layers.push_back(layer_of(plan, *class_table(store.settings().class_table)));
    return layers;
}

GeoBox tile_bounds(const StoreReader& store, const GeoBox& measured) {
    if (StoreBackground{store}.size().is_empty()) {
        return measured;
    }
    const auto all = store.map_box();
    return {.west_deg = std::min(measured.west_deg, all.west_deg),
            .south_deg = std::min(measured.south_deg, all.south_deg),
            .east_deg = std::max(measured.east_deg, all.east_deg),
            .north_deg = std::max(measured.north_deg, all.north_deg)};
}

} // namespace macadam
