#pragma once

#include "estimator/common/geo.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Encodes a line in WGS 84 as PostGIS exchanges it: extended well-known binary, little endian.
std::string ewkb_of(std::span<const GeoPoint> line);

/// Decodes such a line; empty if the value is not one.
std::vector<GeoPoint> line_of_ewkb(std::string_view bytes);

} // namespace macadam
