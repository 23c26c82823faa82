#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/network/road_network.hpp"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace macadam {

/// Tests for an OSM file by suffix: .pbf, .osm, .osm.xml, .osm.gz, .osm.bz2.
bool is_osm_file(const std::filesystem::path& file);

/// Counts of drivable ways that are omitted because they are not real roads and would be costly.
struct LeftOutWays {
    std::size_t in_circles = 0; ///< visit the same few nodes again and again
    std::size_t far_steps = 0;  ///< step between points longer than on any road
};

/// Reads the drivable ways of an OSM file in the order of their ids, with their posted speed limits
/// and the turn restrictions over one node that apply to cars at all hours. Where the file lacks
/// nodes of a way, as at the border of an extract, the way is reduced to its longest part without a
/// missing node.
std::vector<Way>
read_osm(const std::filesystem::path& file, const Progress& progress, LeftOutWays& left_out);

} // namespace macadam
