#pragma once

#include "mapping/network/road_network.hpp"
#include "mapping/simulation/lane.hpp"
#include "mapping/simulation/portable_plane.hpp"

#include <cstdint>
#include <vector>

namespace macadam {

/// An interval of a route in one lane.
struct LanePiece {
    Lane lane;
    double station_m; ///< lane station at the start of the interval
    double from_m;    ///< along the route
    double to_m;
};

/// Path of a car: beside the map's line in its lane, with corners rounded as at the road's usual
/// speed. Sampled about every metre of the route; the car's own travel is slightly more or less
/// than the length of the map's line. All vectors have the size of `route_m`.
struct DrivenPath {
    ExactPlane plane;
    std::vector<LanePiece> pieces;
    std::vector<double> route_m;         ///< increasing from 0, along the map's lines
    std::vector<double> travel_m;        ///< increasing from 0, along the path itself
    std::vector<PointEn> points;         ///< in the plane
    std::vector<double> curvature_per_m; ///< positive to the left
    std::vector<double> wander_m; ///< offset of the car from the centre of its lane, left positive
};

DrivenPath driven_path(const RoadNetwork& roads,
                       const std::vector<EdgeId>& route,
                       const DrivingRecipe& driving,
                       std::uint64_t seed);

/// Position and direction (east, north; unit vector) of the car at a travelled distance, clamped to
/// the path.
struct DrivenPose {
    PointEn at;
    PointEn heading;
};
DrivenPose place_at(const DrivenPath& path, double travel_m);

} // namespace macadam
