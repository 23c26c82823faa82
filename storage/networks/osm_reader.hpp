#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/network/road_network.hpp"
#include "storage/networks/network_cut.hpp"

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace macadam {

/// Tests for an OSM file by suffix: .pbf, .osm, .osm.xml, .osm.gz, .osm.bz2.
bool is_osm_file(const std::filesystem::path& file);

/// Ways that are omitted. Drivable ones are counted: they are no real roads and would be costly, or
/// have no positions.
struct LeftOutWays {
    std::size_t in_circles = 0;     ///< visit the same few nodes again and again
    std::size_t far_steps = 0;      ///< step between points longer than on any road
    std::size_t without_places = 0; ///< fewer than two points have positions
    std::set<std::string> closed{}; ///< values of highway of ways closed to cars, at most 8
};

/// Reads the drivable ways of an OSM file in the order of their ids, with their posted speed limits
/// and the turn restrictions over one node that apply to cars at all hours. Where the file lacks
/// nodes of a way, as at the border of an extract, the way is reduced to its longest part without a
/// missing node.
///
/// \param cut  if given, only ways with a node in its surroundings are read. It takes one more pass
///             over the file, and memory for the nodes there and the turn restrictions of all.
std::vector<Way> read_osm(const std::filesystem::path& file,
                          const Progress& progress,
                          LeftOutWays& left_out,
                          NetworkCut* cut = nullptr);

} // namespace macadam
