#pragma once

#include "storage/geopackage/geopackage.hpp"

namespace macadam {

/// The functions that these triggers call: ST_IsEmpty, ST_MinX, ST_MaxX, ST_MinY, ST_MaxY.
void add_geometry_functions(Database& database);

/// A line as GeoPackageBinary with its envelope, little endian.
std::string geometry_of(std::span<const GeoPoint> line);

/// Its envelope; nothing if it is empty or none.
std::optional<GeoBox> box_of_geometry(std::string_view geometry);

/// The line of such a value. Empty if it is none.
std::vector<GeoPoint> line_of_geometry(std::string_view geometry);

/// Puts it in the place of a line that is not needed any more, whose memory it takes.
void put_line_of_geometry(std::string_view geometry, std::vector<GeoPoint>& line);

} // namespace macadam
