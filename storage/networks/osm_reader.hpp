#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/network/road_network.hpp"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace macadam {

/// Is it an OSM file by its name: .pbf, .osm, .osm.xml, .osm.gz, .osm.bz2?
bool is_osm_file(const std::filesystem::path& file);

/// Drivable ways that are no roads, and are left out: those that would be costly for nothing.
struct LeftOutWays {
    std::size_t in_circles = 0; ///< over the same few nodes again and again
    std::size_t far_steps = 0;  ///< from point to point farther than any road goes
};

/// The drivable ways of an OSM file, in the order of their ids. Where the file lacks a way's nodes,
/// as at the border of an extract, the way's longest part without a missing node stands for it.
/// With their signposted speed limits and the turn restrictions over one node that hold for cars at
/// all hours.
std::vector<Way>
read_osm(const std::filesystem::path& file, const Progress& progress, LeftOutWays& left_out);

} // namespace macadam
