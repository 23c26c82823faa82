#pragma once

#include "estimator/common/trip.hpp"
#include "mapping/network/road_network.hpp"
#include "mapping/network/segment.hpp"

#include <cstdint>
#include <random>
#include <vector>

namespace macadam::testing {

inline constexpr GeoPoint town_corner{59.3, 18.0};

/// Builds a town of side * side crossings about 110 m apart, with irregular positions and bent
/// streets, a fifth of them oneway. Always the same.
/// \param corner  south-west corner
RoadNetwork made_up_town(int side, const GeoPoint& corner = town_corner);

/// Keys of all segments that may be driven, link by link.
std::vector<SegmentKey> keys_of(const RoadNetwork& roads);

struct Journey {
    std::vector<EdgeId> edges;
    std::vector<double> start_m; ///< per edge, followed by the total
};

/// Returns a random journey over `edges` edges, without U-turns.
Journey wander(const RoadNetwork& roads, std::size_t edges, std::mt19937_64& random);

struct Scenario {
    double sd_m; ///< error of a position, per axis; correlated over 30 s
    double fix_step_s;
    bool speeds; ///< wheel speed at 10 Hz
};

inline constexpr double journey_speed_mps = 12;

/// Simulates a receiver 2.5 m to the right of the map's line on the journey at constant speed. The
/// wheels read 0.5 % too much.
TripLog recorded(const RoadNetwork& roads,
                 const Journey& journey,
                 const Scenario& scenario,
                 std::mt19937_64& random);

} // namespace macadam::testing
