#pragma once

#include "mapping/conflation/network_conflation.hpp"
#include "mapping/network/road_network.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// A sampled position along a way that is followed in one direction.
struct RoadSample {
    double offset_m; ///< from the start of the way in that direction
    GeoPoint behind; ///< a few metres back along the way
    GeoPoint at;
    GeoPoint ahead;
    std::uint32_t roads_met = 0; ///< number of links that meet at the position; 0: not a node
};

/// A candidate position of a sample in the other network.
struct EdgeCandidate {
    EdgeId edge;
    double offset_m; ///< along the edge, in its direction
    double across_m; ///< distance from the sample
};

/// Half the chord from which a road's course is measured: a vertex displaced by a metre turns it by
/// 8 degrees.
inline constexpr double half_chord_m = 7.5;

/// Returns the position `along_m` from the way's first node, clamped to its ends.
GeoPoint place_along(const WayView& way, double along_m);

/// Finds the roads of a network around a line.
class CandidateEdges {
public:
    /// \param left_out  by way number: ways to ignore. Both references outlive this object.
    CandidateEdges(const RoadNetwork& roads,
                   const std::vector<bool>& left_out,
                   const ChangeConfig& config);

    /// Returns for each sample the drivable edges within reach that run along its course, each with
    /// its nearest position; nearest first, at most eight.
    std::vector<std::vector<EdgeCandidate>> around(std::span<const RoadSample> samples) const;

private:
    const RoadNetwork* roads_;
    const std::vector<bool>* left_out_;
    ChangeConfig config_;
    double min_cosine_;
};

} // namespace macadam
