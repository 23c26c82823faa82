#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/network/road_network.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace macadam {

// The roads as rows of a store.

/// Two or more places, all on the globe. A store can be changed with any tool for SQLite, so its
/// lines are looked at before anything is made of them.
bool is_line(std::span<const GeoPoint> line);

/// Into table way. \returns SHA-256 of all that was written, in hex digits.
std::string write_ways(Database& database, const RoadNetwork& roads);

/// Of table way as write_ways would fill it.
std::string hash_of_ways(const RoadNetwork& roads);

/// Makes table way, filled with the one network, hold the other.
void update_ways(Database& database, const RoadNetwork& before, const RoadNetwork& after);

struct WrittenSegments {
    std::int64_t segments = 0;
    double length_m = 0; ///< each direction counted
};

/// Into table segment, in the order of keys, in rows of which it has used none yet.
///
/// \param left_out  by number of way: whose segments are not written; empty: none
/// \throws InputError  if it was asked to stop.
WrittenSegments write_segments(Database& database,
                               const RoadNetwork& roads,
                               const Progress& progress,
                               const std::vector<bool>& left_out = {});

/// The ways as they were written, in the order of their ids.
///
/// \throws InputError  if one is no line on the globe.
std::vector<Way> read_ways(Database& database);

} // namespace macadam
