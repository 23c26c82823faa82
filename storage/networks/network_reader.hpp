#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/network/road_network.hpp"
#include "storage/networks/network_cut.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace macadam {

/// Attribute names of a line layer that is not OSM. Empty names select the usual ones.
struct LayerColumns {
    std::string layer; ///< "" = first line layer
    std::string id;    ///< "" = feature id
    std::string name;
    std::string highway;
    std::string oneway; ///< yes|no|-1, 1|0|-1, F|T|B (forward, backward, both), FT|TF
};

/// Step between the way ids of a multi-part line, which becomes one way per part: the first has the
/// feature's id, the others add 1, 2, ... times this step. Thus ids do not depend on the other
/// features.
inline constexpr std::int64_t layer_part_id_step = 1'000'000'000'000;

/// Maximum distance between consecutive points of a road, even in deserts.
inline constexpr double longest_step_m = 50'000;

/// Reads the drivable roads of a map, in the order of their ids. OSM files (.osm.pbf, .osm,
/// .osm.gz, .osm.bz2) keep their node ids, oneway tags and the highway classes open to cars. Any
/// other file is read by GDAL as a line layer in any coordinate system; two lines connect if they
/// share an end point or vertex (to 1e-7 degrees), and nodes are numbered from 1 in the order of
/// the features.
///
/// Omitted are ways with a step of more than longest_step_m between points, and OSM ways that visit
/// the same few nodes again and again.
///
/// \param warn  called with a message about omitted ways, if any.
/// \param cut   if given, only ways with a point in its surroundings are read, perhaps none; memory
///              then grows with an OSM file by its turn restrictions only.
/// \throws InputError  if the file is missing, is not a map, holds no drivable road, or has ids
///                     that are not whole numbers or not unique; if it decompresses to more than a
///                     map would, or has more points than bytes.
std::vector<Way> read_network(const std::filesystem::path& file,
                              const LayerColumns& columns = {},
                              const Progress& progress = {},
                              const std::function<void(const std::string&)>& warn = {},
                              NetworkCut* cut = nullptr);

} // namespace macadam
