#pragma once

#include "estimator/common/trip.hpp"
#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace macadam::bench {

/// From one node of the map to the next, in driving direction.
using NodePair = std::pair<std::int64_t, std::int64_t>;

/// A recorded trip, the map around it and the arcs that it drove.
struct Track {
    std::string name;
    std::vector<Way> ways;
    RoadNetwork roads;
    TripLog trip;
    std::vector<NodePair> truth;
};

/// NAME.osm.pbf, NAME.trip.csv and NAME.truth.csv (columns from_node, to_node) of a folder, in the
/// order of their names.
///
/// \throws InputError  if there is none, or a file is missing or not what it should be.
std::vector<Track> read_tracks(const std::filesystem::path& folder);

/// Without the fixes that follow another within `step_s`.
TripLog thinned(TripLog trip, double step_s);

} // namespace macadam::bench
