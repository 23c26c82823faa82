#pragma once

#include <cstdint>
#include <string_view>

namespace macadam {

/// Returns the default speed limit of an OSM highway class, cm/s: rural limits for classes that
/// connect towns, urban ones for the others; 100 km/h for an unknown class. Errs on the high side,
/// as it serves to exclude speeds that no car can have driven.
std::uint16_t usual_speed_limit_cmps(std::string_view highway);

} // namespace macadam
