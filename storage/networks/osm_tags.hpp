#pragma once

#include "mapping/network/road_network.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <string_view>

namespace macadam {

/// Returns the value of a key of an OSM way; null if the way lacks the key.
using OsmTags = std::function<const char*(const char* key)>;

/// Value of a key; "" if the way lacks the key.
inline std::string_view value(const OsmTags& tags, const char* key) {
    const char* const found = tags(key);
    return found == nullptr ? std::string_view{} : found;
}

template <std::size_t count>
bool is_one_of(std::string_view value, const std::string_view (&values)[count]) {
    return std::ranges::find(values, value) != std::end(values);
}

/// Tests whether an ordinary car may drive on a way. Accepted classes: motorway to residential with
/// their links, living streets, roads of unknown class, service roads, and tracks of grade1
/// (paved). The most specific of motorcar, motor_vehicle, vehicle and access can forbid it (no,
/// agricultural, forestry, emergency, bus, psv and the like). `private` excludes only service roads
/// and tracks, that is yards and driveways; private streets remain, because their users may drive
/// there.
bool is_drivable(const OsmTags& tags);

/// Direction by `oneway`; without that tag, roundabouts and motorways are one-way forward.
Oneway oneway_of(const OsmTags& tags);

/// Speed limit by `maxspeed` in cm/s, of the faster direction if they differ: km/h, or mph where
/// stated. 0 if the limit is missing or depends on the time of day. `none` is 250 km/h, `walk` 7
/// km/h.
std::uint16_t speed_limit_cmps_of(const OsmTags& tags);

/// Value of `name`, otherwise of `ref`.
std::string_view name_of(const OsmTags& tags);

/// Tests for values of `highway` that is_drivable() accepts, tracks included.
bool is_car_class(std::string_view highway);

/// Tests for values of `highway` without car traffic: footway, cycleway and the like.
bool is_for_others(std::string_view highway);

} // namespace macadam
