#pragma once

#include "mapping/conflation/network_conflation.hpp"
#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// A place along a way that is followed in one direction.
struct RoadSample {
    double offset_m; ///< from where the way begins in that direction
    GeoPoint behind; ///< some metres back along the way
    GeoPoint at;
    GeoPoint ahead;
    std::uint32_t roads_met = 0; ///< links that meet there; 0: it is no node
};

/// Where it may be in the other network.
struct NearPlaceOnEdge {
    EdgeId edge;
    double offset_m; ///< along the edge, in its direction
    double across_m; ///< from the sample
};

/// Half of the chord that tells a road's course: a vertex set a metre aside turns it by 8 degrees.
inline constexpr double half_chord_m = 7.5;

/// The way's place `along_m` from its first node; held at its ends.
GeoPoint place_along(const WayView& way, double along_m);

/// The roads of a network around a line.
class CandidateEdges {
public:
    /// \param left_out  by number of way: not looked at. Both outlive this.
    CandidateEdges(const RoadNetwork& roads,
                   const std::vector<bool>& left_out,
                   const ChangeConfig& config);

    /// For each sample the drivable edges within reach that run its course, each with its nearest
    /// place; nearest first, not more than eight.
    std::vector<std::vector<NearPlaceOnEdge>> around(std::span<const RoadSample> samples) const;

private:
    const RoadNetwork* roads_;
    const std::vector<bool>* left_out_;
    ChangeConfig config_;
    double min_cosine_;
};

} // namespace macadam
