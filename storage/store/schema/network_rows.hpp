#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/network/road_network.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace macadam {

// Rows of the road network.

/// Tests for a polyline of two or more valid positions. Any SQLite tool can edit the database, so
/// its polylines are checked before use.
bool is_line(std::span<const GeoPoint> line);

/// Fills table way. \returns SHA-256 of everything written, in hex digits.
std::string write_ways(Database& database, const RoadNetwork& roads);

/// SHA-256 that write_ways would return.
std::string hash_of_ways(const RoadNetwork& roads);

/// Updates table way from one network to another.
void update_ways(Database& database, const RoadNetwork& before, const RoadNetwork& after);

struct WrittenSegments {
    std::int64_t segments = 0;
    double length_m = 0; ///< each direction counted
};

/// Fills table segment in the order of keys, using only new row ids.
///
/// \param left_out  by number of way: true if its segments are not written; empty: none
/// \throws InputError  if a stop is requested.
WrittenSegments write_segments(Database& database,
                               const RoadNetwork& roads,
                               const Progress& progress,
                               const std::vector<bool>& left_out = {});

/// Has write_segments() use rows that no publication knew. Rows are never used twice, also those
/// that a later map removed: publications tell by them which segments they knew.
void reserve_published_rows(Database& database);

/// Segments that write_segments would write.
WrittenSegments count_segments(const RoadNetwork& roads);

/// Updates the box around the segments that the GeoPackage states.
void update_extent(Database& database, const GeoBox& box);

/// Reads the ways in the order of their ids.
///
/// \throws InputError  if a way is not a valid polyline.
std::vector<Way> read_ways(Database& database);

/// Reads those of some ways that are there, in the order of the list.
std::vector<Way> read_ways(Database& database, std::span<const std::int64_t> ids);

} // namespace macadam
