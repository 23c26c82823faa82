#pragma once

#include "mapping/network/road_network.hpp"

#include <filesystem>
#include <span>

namespace macadam {

/// Checks that ways can be stored as OSM.
///
/// \throws InputError  if a node has two positions, or a name more than 1024 bytes. The message
///                     names the way, not its file.
void expect_osm(std::span<const Way> ways);

/// Writes ways as an .osm.pbf that read_network reads back unchanged: ids, node ids and positions
/// (to 1e-7 degrees, the resolution of the format), name, highway, oneway, speed limit and turn
/// rules. Contributors and times are not written. An unknown or missing class becomes
/// `highway=road`. Equal ways give equal bytes.
///
/// \throws InputError  if the file cannot be written, or as expect_osm.
void write_osm(std::span<const Way> ways, const std::filesystem::path& file);

} // namespace macadam
