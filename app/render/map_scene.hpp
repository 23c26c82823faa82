#pragma once

#include "render/scene/scene.hpp"
#include "storage/store/road_store.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Motorway 0 to service 5: what OSM's classes mean for the width of a line.
int rank_of(std::string_view highway);

/// Whether it is drawn in grey. References alone have no passes of cars and need none.
bool has_few_passes(std::int32_t passes, int min_passes);

/// Whether a line shows it in full width: its standard deviation is at most half of it.
bool is_certain(IriUm iri_um, IriUm sd_um);

/// The segments of a store that touch a box, in the order of their keys, with their classes; those
/// without a pass as roads without a measurement, those with fewer than `min_passes` marked so. A
/// segment that references alone tell of has enough.
std::vector<MapLine>
map_lines(const RoadStore& store, const GeoBox& box, const ClassTable& classes, int min_passes = 1);

/// What a picture shows.
struct MapRequest {
    std::optional<GeoBox> box{}; ///< nothing: all that was driven
    std::string title{};
    MapStyle style{};                                            ///< with its class table
    std::shared_ptr<const PlaneProjection> projection = nullptr; ///< null: spherical Mercator
    std::shared_ptr<const BaseMap> base = nullptr;               ///< null: none
    int width_px = 0, height_px = 0;
};

/// What a picture of a store shows: the segments that come to lie on it, with their classes, the
/// roads without a measurement, and the words around them.
///
/// \throws InputError  if the store has no segment in the box.
MapScene map_scene(const RoadStore& store, const MapRequest& request);

} // namespace macadam
