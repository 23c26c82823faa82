#pragma once

#include "render/map.hpp"
#include "storage/road_store.hpp"

#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// The segments of a store that touch a box, in the order of their keys, with their classes; those
/// without a pass as roads without a measurement, those with fewer than `least_passes` marked so. A
/// segment that references alone tell of has enough.
std::vector<MapLine> map_lines(const RoadStore& store,
                               const GeoBox& box,
                               const ClassTable& classes,
                               int least_passes = 1);

/// What a picture of a store shows: its segments in the box (nothing: all that was driven), with
/// their classes, the roads without a measurement, and the words around them.
///
/// \throws InputError  if the store has no segment there.
MapScene map_scene(const RoadStore& store,
                   const std::optional<GeoBox>& box,
                   const ClassTable& classes,
                   const std::string& title,
                   int least_passes = 1);

} // namespace macadam
