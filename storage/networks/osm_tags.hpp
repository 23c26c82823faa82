#pragma once

#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <functional>
#include <string_view>

namespace macadam {

/// The value of a key of an OSM way; null if it has none.
using OsmTags = std::function<const char*(const char* key)>;

/// May an ordinary car drive here? By class: motorway to residential with their links, living
/// streets, roads of unknown class, service roads, and tracks of grade1 (the paved ones). Not where
/// the most particular of motorcar, motor_vehicle, vehicle, access forbids it (no, agricultural,
/// forestry, emergency, bus, psv and the like). `private` shuts service roads and tracks only:
/// yards and driveways are nobody's to report on, but whoever drives on a private street may go
/// there.
bool is_drivable(const OsmTags& tags);

/// By `oneway`; without it roundabouts and motorways run forward.
Oneway oneway_of(const OsmTags& tags);

/// `maxspeed` in cm/s, of the faster direction where they differ: km/h, or as it says mph. 0 where
/// there is none, or one that changes by the hour. `none` is 250 km/h, `walk` 7 km/h.
std::uint16_t speed_limit_cmps_of(const OsmTags& tags);

/// `name`, or failing that `ref`.
std::string_view name_of(const OsmTags& tags);

/// Values of `highway` that no car drives on: footway, cycleway and the like.
bool is_for_others(std::string_view highway);

} // namespace macadam
