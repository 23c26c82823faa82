#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace macadam {

/// Names of attributes in a line layer that is not OSM. Empty: by the usual names.
struct LayerColumns {
    std::string layer; ///< "" = the first line layer
    std::string id;    ///< "" = the feature's own id
    std::string name;
    std::string highway;
    std::string oneway; ///< yes|no|-1, 1|0|-1, F|T|B (forward, backward, both), FT|TF
};

/// A line of several parts in such a layer becomes a way for each part: the first has the feature's
/// id, the next ones have that id and 1, 2, ... times this step. So ids stay the same whatever
/// happens to the other features.
inline constexpr std::int64_t layer_part_id_step = 1'000'000'000'000;

/// Points of a road on a map are nearer than this, in any desert.
inline constexpr double longest_step_m = 50'000;

/// Drivable roads of a map: OSM (.osm.pbf, .osm, .osm.gz, .osm.bz2), with the ids of
/// its nodes, oneway and the highway classes that cars may use; any other file as a line layer by
/// GDAL, in whatever coordinates, where two lines meet if they share an end point or vertex (to
/// 1e-7 degrees; nodes are numbered from 1 in the order of the features). In the order of their
/// ids.
///
/// Left out are ways with a step of more than longest_step_m from point to point, and ways of OSM
/// that go over the same few nodes again and again.
///
/// \param warn  is told in words what was left out, if anything was
/// \throws InputError  if the file is missing, is no map, holds no drivable road, or has ids that
///                     are not whole numbers or occur twice; if it unpacks to more than a map does,
///                     or has more points than bytes.
std::vector<Way> read_network(const std::filesystem::path& file,
                              const LayerColumns& columns = {},
                              const Progress& progress = {},
                              const std::function<void(const std::string&)>& warn = {});

} // namespace macadam
