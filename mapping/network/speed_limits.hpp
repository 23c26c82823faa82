#pragma once

#include <cstdint>
#include <string_view>

namespace macadam {

/// What cars may drive on roads of a class of OSM where no sign says otherwise, cm/s: outside
/// towns on the classes that join towns, inside them on the others; 100 km/h for an unknown class.
/// Rather too high than too low: it serves to tell what no car can have driven.
std::uint16_t usual_speed_limit_cmps(std::string_view highway);

} // namespace macadam
