#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/road_network.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Names of attributes in a line layer that is not OSM. Empty: by the usual names.
struct LayerColumns {
    std::string layer;  ///< "" = the first line layer
    std::string id;     ///< "" = the feature's own id
    std::string name;
    std::string highway;
    std::string oneway; ///< yes|no|-1, 1|0|-1, F|T|B, FT|TF
};

/// Drivable roads of a map: OSM (.osm.pbf, .osm, .osm.gz, .osm.bz2) by libosmium, with the ids of
/// its nodes, oneway and the highway classes that cars may use; any other file as a line layer by
/// GDAL, where two lines meet if they share an end point or vertex (nodes are numbered from 1).
/// In the order of their ids.
///
/// \throws InputError  if the file is missing, is no map, or holds no drivable road.
std::vector<Way> read_network(const std::filesystem::path& file,
                              const LayerColumns& columns = {},
                              const Progress& progress = {});

} // namespace macadam
