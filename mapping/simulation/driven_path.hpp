#pragma once

#include "mapping/network/road_network.hpp"
#include "mapping/simulation/lane.hpp"
#include "mapping/simulation/portable_plane.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// A part of a route in one lane.
struct LanePiece {
    Lane lane;
    double station_m; ///< of the lane, where the piece begins
    double from_m;    ///< along the route
    double to_m;
};

/// Where a car drives: beside the map's line in its lane, corners rounded as drivers do at the
/// road's usual speed. Given about every metre of the route; what the car itself travels is a
/// little more or less than the map's line there. As many of each of the vectors as of `route_m`.
struct DrivenPath {
    ExactPlane plane;
    std::vector<LanePiece> pieces;
    std::vector<double> route_m;         ///< rising from 0, along the map's lines
    std::vector<double> travel_m;        ///< rising from 0, along the path itself
    std::vector<PointEn> points;         ///< in the plane
    std::vector<double> curvature_per_m; ///< positive to the left
    std::vector<double> wander_m;        ///< of the car from its lane's middle, left positive
};

DrivenPath driven_path(const RoadNetwork& roads,
                       const std::vector<EdgeId>& route,
                       const DrivingRecipe& driving,
                       std::uint64_t seed);

/// Where the car is at a travel, held at the ends, and which way it looks (east, north; length 1).
struct PathPlace {
    PointEn at;
    PointEn heading;
};
PathPlace place_at(const DrivenPath& path, double travel_m);

} // namespace macadam
