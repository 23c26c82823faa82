#pragma once

#include "render/map/map_plan.hpp"
#include "storage/store/road_store.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Returns the rank of an OSM class for the width of lines, from motorway 0 to service 5.
int rank_of(std::string_view highway);

/// Returns whether a segment is drawn in grey. Segments known from references only have no passes
/// of cars and need none.
bool has_few_passes(std::int32_t passes, int min_passes);

/// Returns whether a line is drawn in full width: its standard deviation is at most half its value.
bool is_certain(IriUm iri_um, IriUm sd_um);

/// Returns the segments of a database that touch a box, in key order, with their classes. Segments
/// without a pass are roads without a measurement; those with fewer than `min_passes` are marked.
/// Segments known from references only are not marked.
std::vector<MapLine>
map_lines(const RoadStore& store, const GeoBox& box, const ClassTable& classes, int min_passes = 1);

/// Request for a picture.
struct MapRequest {
    std::optional<GeoBox> box{}; ///< `std::nullopt`: the driven extent
    std::string title{};
    MapStyle style{};                                            ///< includes the class table
    std::shared_ptr<const PlaneProjection> projection = nullptr; ///< null: spherical Mercator
    std::shared_ptr<const BaseMap> base = nullptr;               ///< null: none
    int width_px = 0, height_px = 0;
    bool events = false; ///< also potholes and other events
};

/// Plans a picture and loads its roads: the segments on it with their classes, the roads without a
/// measurement, and the text around them.
///
/// \throws InputError  if the database has no segment in the box.
MapPlan load_map(const RoadStore& store, const MapRequest& request);

} // namespace macadam
