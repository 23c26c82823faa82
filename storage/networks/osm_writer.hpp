#pragma once

#include "mapping/network/road_network.hpp"

#include <filesystem>
#include <span>

namespace macadam {

/// \throws InputError  if OSM cannot hold a way: a node has two places, a name more than 1024
/// bytes.
///                     The message names the way, not its file.
void expect_osm(std::span<const Way> ways);

/// Writes ways as an .osm.pbf that read_network reads back as the same ways: their ids, the ids and
/// places of their nodes (to 1e-7 degrees, the format's own grid), name, highway, oneway, speed
/// limit and turn rules.
/// Nothing else: no contributors, no times. A class that OSM does not know, or none, becomes
/// `highway=road`. Equal ways give equal bytes.
///
/// \throws InputError  if the file cannot be written, or as expect_osm.
void write_osm(std::span<const Way> ways, const std::filesystem::path& file);

} // namespace macadam
