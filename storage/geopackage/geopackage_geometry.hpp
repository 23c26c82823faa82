#pragma once

#include "storage/geopackage/geopackage.hpp"

namespace macadam {

/// Registers the functions that the R-tree triggers call: ST_IsEmpty, ST_MinX, ST_MaxX, ST_MinY,
/// ST_MaxY.
void add_geometry_functions(Database& database);

/// Encodes a line as GeoPackageBinary with its envelope, little endian.
std::string geometry_of(std::span<const GeoPoint> line);

/// Encodes a point in the same way.
std::string geometry_of(const GeoPoint& point);

/// Envelope of a geometry; `std::nullopt` if the geometry is empty or invalid.
std::optional<GeoBox> box_of_geometry(std::string_view geometry);

/// Decodes a line; empty if the value is not a line.
std::vector<GeoPoint> line_of_geometry(std::string_view geometry);

/// Decodes a line into an existing one, to reuse its memory.
void put_line_of_geometry(std::string_view geometry, std::vector<GeoPoint>& line);

} // namespace macadam
